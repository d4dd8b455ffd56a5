// The symmetric form of the exchange matrix against dense Eigen arithmetic and the row form.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "matrix/operands.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

enum class Pattern { dense, runs, scattered, empty };

/// A reciprocal F of rows below 1, areas over four decades, patches in a random order. Upper
/// values, in that order, are floats, so that both precisions store the same numbers.
struct Sample {
  std::vector<double> area;
  std::vector<Index> order;
  RowMajor f;

  Sample(std::size_t n, Pattern pattern, unsigned seed, bool with_diagonal = false)
      : area(n), order(n), f(RowMajor::Zero(Eigen::Index(n), Eigen::Index(n))) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (double& a : area) a = std::pow(10.0, 4 * uniform(random) - 2);
    std::iota(order.begin(), order.end(), Index(0));
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t q = k + (with_diagonal ? 0 : 1); q < n; ++q) {
        const double draw = 1 - uniform(random);
        if (!present(pattern, k, q, uniform(random))) continue;
        const Eigen::Index i = order[k];
        const Eigen::Index j = order[q];
        const double most = std::min(1.0, area[order[q]] / area[order[k]]) / double(n);
        f(i, j) = double(float(draw * most));
        if (i != j) f(j, i) = f(i, j) * area[order[k]] / area[order[q]];
      }
    }
  }
  static bool present(Pattern pattern, std::size_t k, std::size_t q, double draw) {
    switch (pattern) {
      case Pattern::dense:
        return draw < 0.98;
      case Pattern::runs:  // blocks of 9 or so that see each other or do not
        return ((k / 9) * 7 + (q / 13) * 5) % 3 == 1;
      case Pattern::scattered:
        return draw < 0.05;
      case Pattern::empty:
        break;
    }
    return false;
  }
  std::vector<double> upper(std::size_t k) const {
    std::vector<double> row;
    for (std::size_t q = k; q < order.size(); ++q) row.push_back(f(order[k], order[q]));
    return row;
  }
  SymmetricMatrix matrix(Precision precision) const {
    auto matrix = SymmetricMatrix(area, order, precision);
    for (std::size_t k = 0; k < order.size(); ++k) matrix.setUpperRow(k, upper(k));
    return matrix;
  }
};

constexpr Pattern kPatterns[] = {Pattern::dense, Pattern::runs, Pattern::scattered, Pattern::empty};

/// F x by Eigen.
RowMajor times(const RowMajor& f, const std::vector<double>& x, int bands) {
  return f * Eigen::Map<const RowMajor>(x.data(), f.cols(), bands);
}

TEST(SymmetricForm, EveryEntryIsReadFromBothEnds) {
  for (const Pattern pattern : kPatterns) {
    const Sample sample(150, pattern, 1, true);
    for (const Precision precision : test::kPrecisions) {
      const SymmetricMatrix matrix = sample.matrix(precision);
      EXPECT_TRUE(matrix.isSymmetric());
      std::size_t entries = 0;
      for (Index i = 0; i < 150; ++i) {
        for (Index j = 0; j < 150; ++j) {
          EXPECT_EQ(matrix.at(i, j), sample.f(i, j)) << i << ' ' << j;
          entries += sample.f(i, j) != 0 ? 1 : 0;
        }
      }
      EXPECT_EQ(matrix.nonZeros(), entries);
      EXPECT_EQ(reciprocityResidual(matrix), 0.0);
    }
  }
}

TEST(SymmetricForm, RowsAndPanelsVisitEntriesInOrder) {
  for (const Pattern pattern : kPatterns) {
    const Sample sample(97, pattern, 2, true);
    const SymmetricMatrix matrix = sample.matrix(Precision::single_precision);
    std::size_t next = 0;
    matrix.forPanels([&](const RowPanel& panel) {
      EXPECT_EQ(panel.first(), next);
      next = panel.last();
      for (std::size_t i = panel.first(); i < panel.last(); ++i) {
        std::vector<double> in_panel(97, 0.0);
        std::vector<double> in_row(97, 0.0);
        Index last = 0;
        panel.forRow(i, [&](Index j, double value) {
          EXPECT_TRUE(last <= j);
          EXPECT_NE(value, 0.0);
          in_panel[last = j] = value;
        });
        matrix.forRow(i, [&](Index j, double value) { in_row[j] = value; });
        for (Index j = 0; j < 97; ++j) {
          EXPECT_EQ(in_panel[j], sample.f(Eigen::Index(i), j));
          EXPECT_EQ(in_row[j], sample.f(Eigen::Index(i), j));
        }
        std::size_t inside = 0;
        matrix.forRow(i, 20, 60, [&](Index j, double) { inside += j >= 20 && j < 60 ? 1 : 0; });
        EXPECT_EQ(
            inside,
            std::size_t((sample.f.row(Eigen::Index(i)).segment(20, 40).array() != 0).count()));
      }
    });
    EXPECT_EQ(next, 97u);
  }
}

/// Panels of a matrix of n rows with an entry in every `stride`-th column hold all rows, once.
void expectPanelsOfAllRows(std::size_t n, std::size_t stride) {
  std::vector<Index> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = Index((k * 1001) % n);  // coprime to n
  auto matrix = SymmetricMatrix(std::vector<double>(n, 1.0), order, Precision::single_precision);
  const auto value = [=](std::size_t k, std::size_t q) {
    return (k + q) % stride == 0 ? std::ldexp(double(1 + (k * q) % 7), -16) : 0.0;
  };
  std::vector<Index> position(n);
  for (std::size_t k = 0; k < n; ++k) {
    position[order[k]] = Index(k);
    std::vector<double> row(n - k);
    for (std::size_t q = k; q < n; ++q) row[q - k] = value(k, q);
    matrix.setUpperRow(k, row);
  }
  std::size_t panels = 0;
  std::size_t entries = 0;
  matrix.forPanels([&](const RowPanel& panel) {
    ++panels;
    for (std::size_t i = panel.first(); i < panel.last(); ++i) {
      panel.forRow(i, [&](Index j, double f) {
        const auto [k, q] = std::minmax(position[i], position[j]);
        ASSERT_EQ(f, value(k, q));
        ++entries;
      });
    }
  });
  const std::size_t bytes = entries * RowPanel::kEntryBytes;
  const std::size_t most = ExchangeMatrix::panelBytes(matrix.bytes());
  EXPECT_GE(panels, 2u);
  EXPECT_GE(panels, (bytes + most - 1) / most);
  EXPECT_LE(panels, 2 * (bytes / most + 1));
  EXPECT_EQ(entries, matrix.nonZeros());
  EXPECT_EQ(entries, n * n / stride);
}

// Panels that hold only part of the rows: entries take 60 MB, 120 MB in the sparse matrix.
TEST(SymmetricForm, SeveralPanelsCoverAllRowsOnce) { expectPanelsOfAllRows(5000, 5); }

TEST(SymmetricForm, SeveralPanelsOfASparseMatrixCoverAllRowsOnce) {
  expectPanelsOfAllRows(20000, 40);
}

TEST(SymmetricForm, AnEmptyPanelHasNoRows) {
  for (const std::size_t n : {0, 3}) {
    const auto matrix = SymmetricMatrix(std::vector<double>(n, 1.0),
                                        n == 0 ? std::vector<Index>{} : std::vector<Index>{2, 0, 1},
                                        Precision::single_precision);
    const RowPanel panel(matrix, n, n);
    EXPECT_EQ(panel.first(), panel.last());
    matrix.forPanels([&](const RowPanel& rows) { EXPECT_EQ(rows.last() - rows.first(), n); });
  }
}

// Up to 19 bands: several walks along a row, and a second pass. The row form is a second,
// independent summation.
TEST(SymmetricForm, ProductAgreesWithEigenAndTheRowForm) {
  for (const Pattern pattern : kPatterns) {
    const std::size_t n = 401;  // four chunks
    const Sample sample(n, pattern, 3, pattern == Pattern::dense);
    const SymmetricMatrix matrix = sample.matrix(Precision::single_precision);
    RowMatrix rows(sample.area, Precision::double_precision);
    for (Index i = 0; i < n; ++i) {
      std::vector<Index> columns;
      std::vector<double> values;
      matrix.forRow(i, [&](Index j, double value) {
        columns.push_back(j);
        values.push_back(value);
      });
      rows.setRow(i, columns, values);
    }
    for (const int bands : {1, 2, 3, 4, 5, 6, 7, 8, 9, 16, 19}) {
      const std::vector<double> x = test::randomVector(n * std::size_t(bands), 4);
      std::vector<double> y(x.size(), NAN);
      std::vector<double> by_rows(x.size());
      matrix.product(x, bands, y);
      rows.product(x, bands, by_rows);
      const RowMajor expected = times(sample.f, x, bands);
      for (std::size_t k = 0; k < y.size(); ++k) {
        // 401 terms >= 0 summed in another order: relative 401 * 2^-53.
        EXPECT_NEAR(y[k], expected.data()[k], 5e-14 * expected.data()[k]);
        EXPECT_NEAR(by_rows[k], expected.data()[k], 5e-14 * expected.data()[k]);
      }
    }
    const std::vector<double> sums = matrix.rowSums();
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_NEAR(sums[i], sample.f.row(Eigen::Index(i)).sum(), 5e-14);
    }
  }
}

TEST(SymmetricForm, ThreadsDoNotChangeABit) {
  for (const Pattern pattern : {Pattern::dense, Pattern::runs, Pattern::scattered}) {
    const std::size_t n = 1100;
    const Sample sample(n, pattern, 5);
    const std::vector<double> x = test::randomVector(n * 3, 6);
    std::vector<std::vector<double>> products;
    std::vector<std::size_t> bytes;
    for (const int threads : {1, 2, 4}) {
      setThreads(threads);
      const SymmetricMatrix matrix = sample.matrix(Precision::single_precision);
      matrix.product(x, 3, products.emplace_back(n * 3));
      bytes.push_back(matrix.bytes());
    }
    setThreads(0);
    EXPECT_EQ(products[0], products[1]);
    EXPECT_EQ(products[0], products[2]);
    EXPECT_EQ(bytes[0], bytes[2]);
  }
}

// The same scene with its patches numbered otherwise: the order names the same patches in turn.
TEST(SymmetricForm, NumberingDoesNotChangeABit) {
  const std::size_t n = 300;
  const Sample sample(n, Pattern::runs, 7);
  std::vector<Index> renamed(n);
  std::iota(renamed.begin(), renamed.end(), Index(0));
  std::shuffle(renamed.begin(), renamed.end(), std::mt19937(8));
  std::vector<double> area(n);
  std::vector<Index> order(n);
  for (std::size_t i = 0; i < n; ++i) {
    area[renamed[i]] = sample.area[i];
    order[i] = renamed[sample.order[i]];
  }
  auto matrix = SymmetricMatrix(area, order, Precision::single_precision);
  for (std::size_t k = 0; k < n; ++k) matrix.setUpperRow(k, sample.upper(k));
  const SymmetricMatrix plain = sample.matrix(Precision::single_precision);
  const std::vector<double> x = test::randomVector(n * 3, 9);
  std::vector<double> other_x(n * 3);
  for (std::size_t i = 0; i < n; ++i) {
    std::copy_n(&x[i * 3], 3, &other_x[renamed[i] * 3]);
  }
  std::vector<double> y(n * 3);
  std::vector<double> other_y(n * 3);
  plain.product(x, 3, y);
  matrix.product(other_x, 3, other_y);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t b = 0; b < 3; ++b) EXPECT_EQ(y[i * 3 + b], other_y[renamed[i] * 3 + b]);
  }
}

// A scene 2^40 times as large or small: the same form factors, the same bits.
TEST(SymmetricForm, ScaleDoesNotChangeABit) {
  const std::size_t n = 200;
  const Sample sample(n, Pattern::dense, 10);
  const std::vector<double> x = test::randomVector(n, 11);
  std::vector<double> reference(n);
  sample.matrix(Precision::single_precision).product(x, 1, reference);
  for (const int exponent : {-500, -80, 80, 500}) {
    Sample scaled = sample;
    for (double& area : scaled.area) area = std::ldexp(area, exponent);
    const SymmetricMatrix matrix = scaled.matrix(Precision::single_precision);
    std::vector<double> y(n);
    matrix.product(x, 1, y);
    EXPECT_EQ(y, reference) << exponent;
    EXPECT_EQ(matrix.at(3, 4), sample.f(3, 4));
  }
}

// A sweep that changes x as it goes sees the changed values, in the order of storage.
TEST(SymmetricForm, SweepGathersUpdatedValues) {
  for (const Pattern pattern : kPatterns) {
    for (const int bands : {1, 3, 6}) {
      const std::size_t n = 130;
      const auto width = std::size_t(bands);
      const Sample sample(n, pattern, 12, true);
      const SymmetricMatrix matrix = sample.matrix(Precision::single_precision);
      std::vector<double> x = test::randomVector(n * width, 13);
      RowMajor expected = Eigen::Map<const RowMajor>(x.data(), Eigen::Index(n), bands);
      std::vector<Index> visited;
      matrix.sweep(x, bands,
                   [&](std::size_t i, const double* gathered) {
                     visited.push_back(Index(i));
                     const RowMajor sums = sample.f.row(Eigen::Index(i)) * expected;
                     for (std::size_t b = 0; b < width; ++b) {
                       // 130 terms >= 0 in another order.
                       EXPECT_NEAR(gathered[b], sums(0, Eigen::Index(b)),
                                   2e-14 * sums(0, Eigen::Index(b)));
                       x[i * width + b] = 1 + 0.5 * gathered[b];
                       expected(Eigen::Index(i), Eigen::Index(b)) = x[i * width + b];
                     }
                   },
                   {});
      EXPECT_EQ(visited, sample.order);
    }
  }
}

TEST(SymmetricForm, TakesHalfTheMemoryAndNoneForZeros) {
  const std::size_t n = 600;
  const auto bytes = [&](Pattern pattern, Precision precision) {
    return double(Sample(n, pattern, 14).matrix(precision).bytes());
  };
  const double half = double(n) * double(n) / 2;
  const auto row = [](std::size_t value) {
    return 8.0 + 7.0 * double(value);
  };  // diagonal, overrun
  // Every fiftieth value is 0 and is stored; a header of 4 bytes a row.
  EXPECT_LE(bytes(Pattern::dense, Precision::single_precision), half * 4 + n * (4 + row(4)));
  EXPECT_LE(bytes(Pattern::dense, Precision::double_precision), half * 8 * 1.01 + n * (4 + row(8)));
  // A third of the values in runs of 13, a header of 4 bytes each.
  EXPECT_LT(bytes(Pattern::runs, Precision::single_precision),
            half / 3 * (4 + 4 / 13.0) * 1.1 + n * row(4));
  // Scattered entries cost no more than a column index and a value.
  EXPECT_LE(bytes(Pattern::scattered, Precision::single_precision),
            half * 0.05 * 8 * 1.1 + n * row(4));
  EXPECT_EQ(bytes(Pattern::empty, Precision::single_precision), n * 8.0);
}

TEST(SymmetricForm, EstimateIsAnUpperBound) {
  const std::size_t n = 600;
  for (const Pattern pattern : kPatterns) {
    for (const Precision precision : test::kPrecisions) {
      const SymmetricMatrix matrix = Sample(n, pattern, 15).matrix(precision);
      const double per_row = double(matrix.nonZeros()) / double(n);
      const auto estimate = double(estimateSymmetricBytes(n, per_row, precision));
      EXPECT_LE(double(matrix.bytes()), estimate);
      const double row_form = double(estimateRowFormBytes(n, per_row, precision));
      EXPECT_LE(estimate, 0.55 * row_form + double(n) * 200);  // constant cost of a row
    }
  }
}

// Runs and gaps longer than 65,535 are stored in parts.
TEST(SymmetricForm, LongRunsAndGapsAreReadBack) {
  const std::size_t n = 200001;
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index(0));
  auto matrix = SymmetricMatrix(std::vector<double>(n, 1.0), order, Precision::single_precision);
  std::vector<double> row(n, 0.0);
  std::fill(row.begin() + 1, row.begin() + 140001, std::ldexp(1.0, -20));
  matrix.setUpperRow(0, row);
  std::fill(row.begin(), row.end(), 0.0);
  row[150000] = 0.25;
  row[199998] = 0.5;
  matrix.setUpperRow(2, std::span(row).first(n - 2));
  EXPECT_EQ(matrix.at(0, 140000), std::ldexp(1.0, -20));
  EXPECT_EQ(matrix.at(0, 140001), 0.0);
  EXPECT_EQ(matrix.at(150002, 2), 0.25);
  EXPECT_EQ(matrix.at(2, 200000), 0.5);
  EXPECT_EQ(matrix.nonZeros(), 2 * 140002u);
  const std::vector<double> sums = matrix.rowSums();
  EXPECT_EQ(sums[0], 140000 * std::ldexp(1.0, -20));
  EXPECT_EQ(sums[2], 0.75 + std::ldexp(1.0, -20));
  EXPECT_EQ(sums[150002], 0.25);
}

TEST(SymmetricForm, UpperRowsAreReadBackAndReplaced) {
  const Sample sample(80, Pattern::runs, 16, true);
  SymmetricMatrix matrix = sample.matrix(Precision::single_precision);
  std::vector<double> row(80 - 7);
  matrix.upperRow(7, row);
  EXPECT_EQ(row, sample.upper(7));
  matrix.setUpperRow(7, std::vector<double>{0.0, 0.0, 0.25});  // the rest is 0
  matrix.upperRow(7, row);
  EXPECT_EQ(row[2], 0.25);
  EXPECT_EQ(std::accumulate(row.begin(), row.end(), 0.0), 0.25);
  matrix.setUpperRow(7, {});
  EXPECT_EQ(matrix.at(sample.order[7], sample.order[9]), 0.0);
}

TEST(SymmetricForm, RefusesImpossibleFormFactors) {
  const auto make = [](std::vector<Index> order) {
    return SymmetricMatrix({1.0, 0.0, 1.0}, std::move(order), Precision::single_precision);
  };
  EXPECT_THROW(make({0, 1}), InputError);
  EXPECT_THROW(make({0, 1, 1}), InputError);
  EXPECT_THROW(make({0, 1, 3}), InputError);
  SymmetricMatrix matrix = make({2, 1, 0});
  const auto set = [&](std::size_t k, std::vector<double> factors) {
    matrix.setUpperRow(k, factors);
  };
  EXPECT_THROW(set(3, {}), InputError);
  EXPECT_THROW(set(1, {0, 0, 0}), InputError);
  EXPECT_THROW(set(0, {0, 0, -0.1}), InputError);
  EXPECT_THROW(set(0, {0, 0, std::nan("")}), InputError);
  EXPECT_THROW(set(0, {0, 0, double(INFINITY)}), InputError);
  EXPECT_THROW(set(0, {0, 0.1, 0.1}), InputError);  // to a patch without area
  EXPECT_THROW(set(1, {0, 0.1}), InputError);       // from one
  EXPECT_EQ(matrix.nonZeros(), 0u);
  set(0, {0.25, 0, 0.5});
  EXPECT_EQ(matrix.rowSums(), (std::vector<double>{0.5, 0.0, 0.75}));
}

}  // namespace
}  // namespace radiosity
