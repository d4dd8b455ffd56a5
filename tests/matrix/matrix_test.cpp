// A matrix of rows against plain dense arithmetic, and its reciprocity by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "matrix/operands.h"
#include "radiosity/matrix_functions.h"

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

RowMatrix toMatrix(const Dense& dense, std::vector<double> area, Precision precision) {
  RowMatrix matrix(std::move(area), precision);
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

TEST(RowMatrix, StoresEachRowInTheSmallerForm) {
  const std::size_t n = 12;
  RowMatrix matrix(std::vector<double>(n, 1.0), Precision::single_precision);
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

TEST(RowMatrix, VisitsAColumnRangeInOrder) {
  for (const double fill : {0.1, 0.9}) {
    const Dense dense = randomDense(50, fill, 3);
    const auto matrix = toMatrix(dense, std::vector<double>(50, 1.0), Precision::double_precision);
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
TEST(RowMatrix, ProductIsTheSumOverColumns) {
  const std::size_t n = 101;
  for (const double fill : {0.05, 0.95}) {
    const Dense dense = randomDense(n, fill, 5);
    const auto matrix = toMatrix(dense, std::vector<double>(n, 1.0), Precision::double_precision);
    EXPECT_EQ(matrix.denseRows(), fill < 0.5 ? 0u : n);
    for (int bands = 1; bands <= 9; ++bands) {
      const auto width = std::size_t(bands);
      const std::vector<double> x = test::randomVector(n * width, 8);
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
TEST(RowMatrix, StorageAndThreadsDoNotChangeABit) {
  const std::size_t n = 60;
  const std::size_t padded = 400;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    const Dense dense = randomDense(n, 0.9, 11);
    Dense wide(padded, std::vector<double>(padded, 0.0));
    for (std::size_t i = 0; i < n; ++i)
      std::copy(dense[i].begin(), dense[i].end(), wide[i].begin());
    const auto as_dense = toMatrix(dense, std::vector<double>(n, 1.0), precision);
    const auto as_sparse = toMatrix(wide, std::vector<double>(padded, 1.0), precision);
    ASSERT_EQ(as_dense.denseRows(), n);
    ASSERT_EQ(as_sparse.denseRows(), 0u);
    const std::vector<double> x = test::randomVector(padded * 3, 2);
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

TEST(RowMatrix, EstimateEqualsTheStoredBytes) {
  const std::size_t n = 200;
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    for (const std::size_t entries : {std::size_t{3}, std::size_t{90}, std::size_t{150}, n}) {
      RowMatrix matrix(std::vector<double>(n, 1.0), precision);
      std::vector<Index> columns(entries);
      for (std::size_t k = 0; k < entries; ++k) columns[k] = Index(k);
      const std::vector<double> values(entries, 0.5);
      for (std::size_t i = 0; i < n; ++i) matrix.setRow(i, columns, values);
      EXPECT_EQ(matrix.bytes(), estimateRowFormBytes(n, double(entries), precision));
    }
  }
}

TEST(RowMatrix, RefusesImpossibleFormFactors) {
  const double nan = std::nan("");
  EXPECT_THROW(RowMatrix({1.0, -1.0}, Precision::double_precision), InputError);
  EXPECT_THROW(RowMatrix({1.0, nan}, Precision::double_precision), InputError);
  RowMatrix matrix({1.0, 1.0, 1.0}, Precision::double_precision);
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
TEST(Reciprocity, ResidualEqualsThatByHand) {
  const auto matrix = toMatrix({{0, 0.3}, {0.5, 0}}, {2.0, 1.0}, Precision::double_precision);
  EXPECT_NEAR(reciprocityResidual(matrix), std::sqrt(0.02 / 0.61), 1e-15);  // rounding
  const auto exact = toMatrix({{0, 0.25}, {0.5, 0}}, {2.0, 1.0}, Precision::double_precision);
  EXPECT_EQ(reciprocityResidual(exact), 0.0);
  EXPECT_EQ(reciprocityResidual(RowMatrix({1.0, 1.0}, Precision::single_precision)), 0.0);
  EXPECT_EQ(reciprocityResidual(RowMatrix({}, Precision::single_precision)), 0.0);
}

// A_0 = 2, A_1 = 1: the estimate made at patch 0 gets 1/5, the one at patch 1 gets 4/5.
TEST(Reciprocity, MergeTrustsTheSmallerPatch) {
  const auto merged =
      symmetrized(toMatrix({{0, 0.3}, {0.5, 0}}, {2.0, 1.0}, Precision::double_precision));
  const double g = 0.2 * 0.6 + 0.8 * 0.5;
  EXPECT_NEAR(merged.at(0, 1), g / 2, 1e-16);  // rounding
  EXPECT_NEAR(merged.at(1, 0), g, 2e-16);
  // An estimate from one end alone is merged with the zero seen from the other.
  const auto one_sided =
      symmetrized(toMatrix({{0, 0.3}, {0, 0}}, {2.0, 1.0}, Precision::double_precision));
  EXPECT_NEAR(one_sided.at(0, 1), 0.06, 1e-16);
  EXPECT_NEAR(one_sided.at(1, 0), 0.12, 1e-16);
}

TEST(Reciprocity, MergedMatrixIsSymmetric) {
  const std::size_t n = 300;  // more than one block of columns
  const std::vector<double> area = test::randomVector(n, 21);
  for (const double fill : {0.03, 0.9}) {
    const Dense dense = randomDense(n, fill, 22);
    const auto matrix = toMatrix(dense, area, Precision::double_precision);
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

}  // namespace
}  // namespace radiosity
