// The exchange matrix against plain dense arithmetic, and its reciprocity and closure by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "radiosity/closure.h"

namespace radiosity {
namespace {

using Dense = std::vector<std::vector<double>>;

/// `fill` of the entries are non-zero, values in (0, 1].
Dense randomDense(std::size_t n, double fill, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  Dense dense(n, std::vector<double>(n, 0.0));
  for (auto& row : dense) {
    for (double& value : row) {
      if (uniform(random) < fill) value = 1.0 - uniform(random);
    }
  }
  return dense;
}

ExchangeMatrix toMatrix(const Dense& dense, std::vector<double> area, Precision precision) {
  ExchangeMatrix matrix(std::move(area), precision);
  for (std::size_t i = 0; i < dense.size(); ++i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (std::size_t j = 0; j < dense.size(); ++j) {
      if (dense[i][j] == 0) continue;
      columns.push_back(Index(j));
      values.push_back(dense[i][j]);
    }
    matrix.setRow(i, columns, values);
  }
  return matrix;
}

std::vector<double> randomVector(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.5, 2.0);
  std::vector<double> values(n);
  for (double& value : values) value = uniform(random);
  return values;
}

TEST(ExchangeMatrix, StoresEachRowTheSmallerWay) {
  const std::size_t n = 12;
  ExchangeMatrix matrix(std::vector<double>(n, 1.0), Precision::single);
  const std::vector<Index> six{0, 2, 4, 6, 8, 10};
  const std::vector<Index> seven{0, 2, 4, 6, 8, 10, 11};
  const std::vector<double> values(7, 0.25);
  matrix.setRow(0, six, std::span(values).first(6));  // 6 * (4 + 4) = 12 * 4 bytes: a draw
  EXPECT_EQ(matrix.denseRows(), 0u);
  EXPECT_EQ(matrix.bytes(), 48u);
  matrix.setRow(1, seven, values);  // 7 * 8 > 12 * 4
  EXPECT_EQ(matrix.denseRows(), 1u);
  EXPECT_EQ(matrix.bytes(), 96u);
  EXPECT_EQ(matrix.nonZeros(), 13u);
  EXPECT_EQ(matrix.at(0, 4), 0.25);
  EXPECT_EQ(matrix.at(0, 5), 0.0);
  EXPECT_EQ(matrix.at(1, 11), 0.25);
  EXPECT_EQ(matrix.at(1, 9), 0.0);
  matrix.setRow(1, std::span(six).first(1), std::span(values).first(1));
  EXPECT_EQ(matrix.denseRows(), 0u);
  EXPECT_EQ(matrix.nonZeros(), 7u);
}

TEST(ExchangeMatrix, VisitsAColumnRangeInOrder) {
  for (const double fill : {0.1, 0.9}) {
    const Dense dense = randomDense(50, fill, 3);
    const auto matrix = toMatrix(dense, std::vector<double>(50, 1.0), Precision::real);
    std::vector<Index> expected;
    std::vector<Index> visited;
    for (Index j = 11; j < 33; ++j) {
      if (dense[7][j] != 0) expected.push_back(j);
    }
    matrix.forRow(7, 11, 33, [&](Index j, double value) {
      visited.push_back(j);
      EXPECT_EQ(value, dense[7][j]);
    });
    EXPECT_EQ(visited, expected);
  }
}

// Sparse rows and dense rows, 1 to 9 bands (several walks along a row), against the definition.
TEST(ExchangeMatrix, ProductIsTheSumOverColumns) {
  const std::size_t n = 101;
  for (const double fill : {0.05, 0.95}) {
    const Dense dense = randomDense(n, fill, 5);
    const auto matrix = toMatrix(dense, std::vector<double>(n, 1.0), Precision::real);
    EXPECT_EQ(matrix.denseRows(), fill < 0.5 ? 0u : n);
    for (int bands = 1; bands <= 9; ++bands) {
      const auto width = std::size_t(bands);
      const std::vector<double> x = randomVector(n * width, 8);
      std::vector<double> y(n * width);
      matrix.product(x, bands, y);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t b = 0; b < width; ++b) {
          double expected = 0;
          for (std::size_t j = 0; j < n; ++j) expected += dense[i][j] * x[j * width + b];
          // 101 terms of size up to 2, summed in another order: 101 * 2^-53 relative.
          EXPECT_NEAR(y[i * width + b], expected, 2e-14 * (expected + 1));
        }
      }
    }
  }
}

// Rows that fill most of a small matrix are stored dense;
// padding the matrix with empty columns flips the storage and must not change a bit.
TEST(ExchangeMatrix, StorageAndThreadsDoNotChangeABit) {
  const std::size_t n = 60;
  const std::size_t padded = 400;
  for (const Precision precision : {Precision::single, Precision::real}) {
    const Dense dense = randomDense(n, 0.9, 11);
    Dense wide(padded, std::vector<double>(padded, 0.0));
    for (std::size_t i = 0; i < n; ++i)
      std::copy(dense[i].begin(), dense[i].end(), wide[i].begin());
    const auto as_dense = toMatrix(dense, std::vector<double>(n, 1.0), precision);
    const auto as_sparse = toMatrix(wide, std::vector<double>(padded, 1.0), precision);
    ASSERT_EQ(as_dense.denseRows(), n);
    ASSERT_EQ(as_sparse.denseRows(), 0u);
    const std::vector<double> x = randomVector(padded * 3, 2);
    std::vector<double> dense_y(n * 3);
    std::vector<double> sparse_y(padded * 3);
    std::vector<double> one_thread_y(padded * 3);
    as_dense.product(std::span(x).first(n * 3), 3, dense_y);
    as_sparse.product(x, 3, sparse_y);
    setThreads(1);
    as_sparse.product(x, 3, one_thread_y);
    setThreads(0);
    EXPECT_EQ(sparse_y, one_thread_y);
    sparse_y.resize(n * 3);
    EXPECT_EQ(dense_y, sparse_y);
  }
}

TEST(ExchangeMatrix, EstimateIsWhatIsStored) {
  const std::size_t n = 200;
  for (const Precision precision : {Precision::single, Precision::real}) {
    for (const std::size_t entries : {std::size_t{3}, std::size_t{90}, std::size_t{150}, n}) {
      ExchangeMatrix matrix(std::vector<double>(n, 1.0), precision);
      std::vector<Index> columns(entries);
      for (std::size_t k = 0; k < entries; ++k) columns[k] = Index(k);
      const std::vector<double> values(entries, 0.5);
      for (std::size_t i = 0; i < n; ++i) matrix.setRow(i, columns, values);
      EXPECT_EQ(matrix.bytes(), ExchangeMatrix::estimateBytes(n, double(entries), precision));
    }
  }
}

TEST(ExchangeMatrix, RefusesWhatIsNoFormFactorMatrix) {
  const double nan = std::nan("");
  EXPECT_THROW(ExchangeMatrix({1.0, -1.0}, Precision::real), InputError);
  EXPECT_THROW(ExchangeMatrix({1.0, nan}, Precision::real), InputError);
  ExchangeMatrix matrix({1.0, 1.0, 1.0}, Precision::real);
  const auto set = [&](std::size_t i, std::vector<Index> columns, std::vector<double> values) {
    matrix.setRow(i, columns, values);
  };
  EXPECT_THROW(set(3, {0}, {0.5}), InputError);
  EXPECT_THROW(set(0, {3}, {0.5}), InputError);
  EXPECT_THROW(set(0, {1, 1}, {0.5, 0.5}), InputError);
  EXPECT_THROW(set(0, {2, 1}, {0.5, 0.5}), InputError);
  EXPECT_THROW(set(0, {1, 2}, {0.5}), InputError);
  EXPECT_THROW(set(0, {1}, {-0.5}), InputError);
  EXPECT_THROW(set(0, {1}, {nan}), InputError);
  EXPECT_EQ(matrix.nonZeros(), 0u);
}

// By hand: G = (0, 2*0.3; 1*0.5, 0), differences 0.1 twice, sum of squares 0.36 + 0.25.
TEST(Reciprocity, ResidualByHand) {
  const auto matrix = toMatrix({{0, 0.3}, {0.5, 0}}, {2.0, 1.0}, Precision::real);
  EXPECT_NEAR(reciprocityResidual(matrix), std::sqrt(0.02 / 0.61), 1e-15);  // rounding
  const auto exact = toMatrix({{0, 0.25}, {0.5, 0}}, {2.0, 1.0}, Precision::real);
  EXPECT_EQ(reciprocityResidual(exact), 0.0);
  EXPECT_EQ(reciprocityResidual(ExchangeMatrix({1.0, 1.0}, Precision::single)), 0.0);
  EXPECT_EQ(reciprocityResidual(ExchangeMatrix()), 0.0);
}

// A_0 = 2, A_1 = 1: the estimate made at patch 0 gets 1/5, the one at patch 1 gets 4/5.
TEST(Reciprocity, MergeTrustsTheSmallerPatch) {
  const auto merged = symmetrized(toMatrix({{0, 0.3}, {0.5, 0}}, {2.0, 1.0}, Precision::real));
  const double g = 0.2 * 0.6 + 0.8 * 0.5;
  EXPECT_NEAR(merged.at(0, 1), g / 2, 1e-16);  // rounding
  EXPECT_NEAR(merged.at(1, 0), g, 2e-16);
  // An estimate from one end alone is merged with the zero seen from the other.
  const auto one_sided = symmetrized(toMatrix({{0, 0.3}, {0, 0}}, {2.0, 1.0}, Precision::real));
  EXPECT_NEAR(one_sided.at(0, 1), 0.06, 1e-16);
  EXPECT_NEAR(one_sided.at(1, 0), 0.12, 1e-16);
}

TEST(Reciprocity, MergedMatrixIsSymmetric) {
  const std::size_t n = 300;  // more than one block of columns
  const std::vector<double> area = randomVector(n, 21);
  for (const double fill : {0.03, 0.9}) {
    const Dense dense = randomDense(n, fill, 22);
    const auto matrix = toMatrix(dense, area, Precision::real);
    const auto merged = symmetrized(matrix);
    EXPECT_LT(reciprocityResidual(merged), 1e-15);  // one rounding an entry
    double difference = 0;
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        const double g_ij = area[i] * dense[i][j];
        const double g_ji = area[j] * dense[j][i];
        difference += (g_ij - g_ji) * (g_ij - g_ji);
        total += g_ij * g_ij;
        const double own = area[j] * area[j] / (area[i] * area[i] + area[j] * area[j]);
        // A handful of roundings of values up to 4.
        EXPECT_NEAR(merged.at(i, j) * area[i], own * g_ij + (1 - own) * g_ji, 4e-15);
      }
    }
    EXPECT_NEAR(reciprocityResidual(matrix), std::sqrt(difference / total), 1e-12);  // 9e4 terms
  }
}

TEST(Closure, KeepsReciprocityAndZerosAndReachesTheTarget) {
  const std::size_t n = 200;
  const std::vector<double> area = randomVector(n, 31);
  for (const double fill : {0.1, 0.9}) {
    const auto raw = symmetrized(toMatrix(randomDense(n, fill, 32), area, Precision::real));
    auto matrix = raw;
    std::vector<double> target(n, 1.0);
    for (std::size_t i = 0; i < n; i += 7) target[i] = 0.6;  // a window to the sky
    const ClosureReport report = restoreClosure(matrix, target);
    EXPECT_GT(report.largest_residual_before, 1.0);
    EXPECT_LE(report.largest_residual, 2e-12);  // asked for 1e-12, then rounded once an entry
    EXPECT_LT(reciprocityResidual(matrix), 1e-14);
    const std::vector<double> sums = matrix.rowSums();
    double largest_move = 0;
    double moved = 0;
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(sums[i], target[i], 2e-12);
      for (std::size_t j = 0; j < n; ++j) {
        EXPECT_EQ(matrix.at(i, j) > 0, raw.at(i, j) > 0);
        const double move = matrix.at(i, j) - raw.at(i, j);
        largest_move = std::max(largest_move, std::abs(move));
        moved += area[i] * move * move;
        total += area[i] * raw.at(i, j) * raw.at(i, j);
      }
    }
    EXPECT_EQ(report.largest_move, largest_move);
    EXPECT_NEAR(report.relative_move, std::sqrt(moved / total), 1e-12);  // 4e4 terms
  }
}

TEST(Closure, LeavesAClosedMatrixAndEmptyRowsAlone) {
  auto matrix = toMatrix({{0, 1, 0}, {1, 0, 0}, {0, 0, 0}}, {1.0, 1.0, 0.0}, Precision::single);
  const std::vector<double> target(3, 1.0);
  const ClosureReport report = restoreClosure(matrix, target);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(report.largest_residual, 0.0);
  EXPECT_EQ(matrix.at(0, 1), 1.0);
  EXPECT_EQ(matrix.rowSums()[2], 0.0);
}

// Patch 0 exchanges with 1 and 2, which see only it: the row sums A_i t_i must balance, and with
// three equal areas they cannot. It stops early and the report says so.
TEST(Closure, AnImpossibleTargetIsReported) {
  auto matrix =
      toMatrix({{0, 0.5, 0.5}, {0.5, 0, 0}, {0.5, 0, 0}}, {1.0, 1.0, 1.0}, Precision::real);
  const std::vector<double> target(3, 1.0);
  const ClosureReport report = restoreClosure(matrix, target);
  EXPECT_LT(report.iterations, 200);
  EXPECT_GT(report.largest_residual, 0.2);
  EXPECT_LT(reciprocityResidual(matrix), 1e-14);
}

// Two plates that see little but each other: the second eigenvalue is -0.96, the slow case.
TEST(Closure, NarrowGapsConverge) {
  Dense dense(40, std::vector<double>(40));
  for (std::size_t i = 0; i < 40; ++i) {
    for (std::size_t j = 0; j < 40; ++j) {
      dense[i][j] = (i < 20) == (j < 20) ? 0.001 : 0.049 * (1 + 0.3 * std::sin(double(i + j)));
    }
  }
  auto matrix = toMatrix(dense, std::vector<double>(40, 1.0), Precision::real);
  const std::vector<double> target(40, 1.0);
  const ClosureReport report = restoreClosure(matrix, target);
  EXPECT_GT(report.largest_residual_before, 1e-3);
  EXPECT_LE(report.largest_residual, 2e-12);
}

// A row that saw nothing but is seen: merging gave it entries, the target takes them away again.
TEST(Closure, ATargetOfZeroEmptiesTheRow) {
  auto matrix =
      toMatrix({{0, 0.4, 0.2}, {0.4, 0, 0.1}, {0.2, 0.1, 0}}, {1.0, 1.0, 1.0}, Precision::single);
  const ClosureReport report = restoreClosure(matrix, std::vector<double>{0.5, 0.5, 0.0});
  EXPECT_EQ(matrix.nonZeros(), 2u);
  EXPECT_NEAR(matrix.at(0, 1), 0.5, 1e-7);  // stored in 32 bits
  EXPECT_NEAR(report.largest_move, 0.2, 1e-7);
  EXPECT_THROW(restoreClosure(matrix, std::vector<double>{0.5, 0.5}), InputError);
  EXPECT_THROW(restoreClosure(matrix, std::vector<double>{0.5, 0.5, -1.0}), InputError);
}

}  // namespace
}  // namespace radiosity
