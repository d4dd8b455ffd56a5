// Closure by least squares against dense linear algebra.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "matrix/uncertain_row.h"
#include "radiosity/closure.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// A reciprocal F whose rows sum to 1, and the same with errors in some pairs, all by position (the
/// order of storage numbers patches backwards). Errors are powers of 2^(1/4), which are kept as
/// they are.
struct Scene {
  std::size_t n;
  std::vector<double> area;
  std::vector<Index> order;
  Matrix truth;
  Matrix raw;
  Matrix error;  // 0: known

  Scene(std::size_t size, double share, double spread, unsigned seed)
      : n(size),
        area(size),
        order(size),
        error(Matrix::Zero(Eigen::Index(size), Eigen::Index(size))) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    Matrix g(n, n);
    for (std::size_t k = 0; k < n; ++k) {
      order[k] = Index(n - 1 - k);
      for (std::size_t q = 0; q <= k; ++q) g(k, q) = g(q, k) = k == q ? 0.0 : 0.2 + uniform(random);
    }
    for (std::size_t k = 0; k < n; ++k) area[order[k]] = g.row(Eigen::Index(k)).sum();
    truth = g;
    for (std::size_t k = 0; k < n; ++k) truth.row(Eigen::Index(k)) /= area[order[k]];
    raw = truth;
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t q = k + 1; q < n; ++q) {
        if (uniform(random) >= share) continue;
        error(k, q) = std::exp2(-0.25 * std::floor(20 + 30 * uniform(random))) * spread;
        const double value = truth(k, q) + error(k, q) * (4 * uniform(random) - 2);
        raw(k, q) = std::max(0.0, value);
        raw(q, k) = raw(k, q) * area[order[k]] / area[order[q]];
      }
    }
  }

  SymmetricMatrix matrix(Precision precision = Precision::double_precision) const {
    auto matrix = SymmetricMatrix(area, order, precision);
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<double> row;
      for (std::size_t q = k; q < n; ++q) row.push_back(raw(k, q));
      matrix.setUpperRow(k, row);
    }
    return matrix;
  }
  UncertainEntries uncertain() const {
    UncertainEntries entries(n);
    for (std::size_t k = 0; k < n; ++k) {
      std::vector<Index> later;
      std::vector<double> errors;
      for (std::size_t q = k + 1; q < n; ++q) {
        if (error(k, q) == 0) continue;
        later.push_back(Index(q));
        errors.push_back(error(k, q));
      }
      entries.setRow(k, later, errors);
    }
    return entries;
  }

  struct Pair {
    Eigen::Index k, q;
    double weight;  // error of the exchange area
    double raw;     // exchange area
  };
  std::vector<Pair> pairs() const {
    std::vector<Pair> pairs;
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t q = k + 1; q < n; ++q) {
        const double a = area[order[k]];
        if (error(k, q) > 0) {
          pairs.push_back({Eigen::Index(k), Eigen::Index(q), a * error(k, q), a * raw(k, q)});
        }
      }
    }
    return pairs;
  }
  /// The rows' residuals, as exchange areas.
  Vector lacking() const {
    Vector r(n);
    for (std::size_t k = 0; k < n; ++k) {
      r[Eigen::Index(k)] = area[order[k]] * (1 - raw.row(Eigen::Index(k)).sum());
    }
    return r;
  }
};

/// The least-norm change, in units of each pair's error, that adds `lacking` to the rows while the
/// pairs in `held` go to 0: a complete orthogonal decomposition of the constraints.
Vector leastChange(const std::vector<Scene::Pair>& pairs, Vector lacking,
                   const std::vector<bool>& held) {
  Matrix rows = Matrix::Zero(lacking.size(), Eigen::Index(pairs.size()));
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    const auto& [k, q, weight, raw] = pairs[p];
    if (held[p]) {
      lacking[k] += raw;
      lacking[q] += raw;
    } else {
      rows(k, Eigen::Index(p)) = rows(q, Eigen::Index(p)) = weight;
    }
  }
  Vector change = rows.completeOrthogonalDecomposition().solve(lacking);
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (held[p]) change[Eigen::Index(p)] = -pairs[p].raw / pairs[p].weight;
  }
  return change;
}

ClosureReport closed(SymmetricMatrix& matrix, const UncertainEntries& uncertain,
                     const std::vector<double>& target, double tolerance = 1e-9) {
  Progress silent;
  return closeRows(matrix, uncertain, target, silent, tolerance);
}

SymmetricMatrix ofRows(const std::vector<std::vector<double>>& upper, Precision precision) {
  std::vector<Index> order(upper.size());
  std::iota(order.begin(), order.end(), Index(0));
  auto matrix = SymmetricMatrix(std::vector<double>(upper.size(), 1.0), order, precision);
  for (std::size_t k = 0; k < upper.size(); ++k) matrix.setUpperRow(k, upper[k]);
  return matrix;
}

TEST(LeastSquaresClosure, IsTheLeastChange) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Scene scene(30, 0.4, 1.0 / 64, seed);
    SymmetricMatrix matrix = scene.matrix();
    const ClosureReport report = closed(matrix, scene.uncertain(), std::vector<double>(30, 1.0));
    ASSERT_TRUE(report.reached) << seed;
    EXPECT_EQ(report.emptied, 0u);
    EXPECT_LE(report.largest_residual, 1e-9);
    EXPECT_GT(report.largest_residual_before, 1e-4);
    const auto pairs = scene.pairs();
    EXPECT_EQ(report.adjustable, pairs.size());
    const Vector expected =
        leastChange(pairs, scene.lacking(), std::vector<bool>(pairs.size(), false));
    double raw_error = 0;
    double moved = 0;
    double error = 0;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto& [k, q, weight, raw] = pairs[p];
      const double g = scene.area[scene.order[std::size_t(k)]];
      const double now = g * matrix.at(scene.order[std::size_t(k)], scene.order[std::size_t(q)]);
      // The rows are closed to 1e-9, not exactly: in units of the smallest errors, 2^-18, 3e-4 of
      // one; the changes themselves are about 1.
      EXPECT_NEAR((now - raw) / weight, expected[Eigen::Index(p)], 1e-3) << seed;
      const double truth = g * scene.truth(k, q);
      raw_error += std::pow((raw - truth) / weight, 2);
      moved += std::pow((now - raw) / weight, 2);
      error += std::pow((now - truth) / weight, 2);
    }
    // The truth satisfies the constraints: the change is the orthogonal projection (Pythagoras).
    EXPECT_NEAR(moved + error, raw_error, 1e-3 * raw_error);
    EXPECT_LT(error, raw_error);
  }
}

TEST(LeastSquaresClosure, LeavesKnownEntriesUnchanged) {
  const Scene scene(40, 0.3, 1.0 / 64, 3);
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    SymmetricMatrix matrix = scene.matrix(precision);
    const SymmetricMatrix before = scene.matrix(precision);
    const ClosureReport report = closed(matrix, scene.uncertain(), std::vector<double>(40, 1.0));
    EXPECT_TRUE(report.reached) << report.largest_residual;
    double largest = 0;
    double moved = 0;
    double total = 0;
    for (Index k = 0; k < 40; ++k) {
      double sum = 0;
      for (Index q = 0; q < 40; ++q) {
        const Index i = scene.order[k];
        const Index j = scene.order[q];
        const double move = matrix.at(i, j) - before.at(i, j);
        if (scene.error(std::min(k, q), std::max(k, q)) == 0) {
          EXPECT_EQ(move, 0.0);
        }
        largest = std::max(largest, std::abs(move));
        moved += scene.area[i] * move * move;
        total += scene.area[i] * before.at(i, j) * before.at(i, j);
        sum += matrix.at(i, j);
      }
      // The tolerance, 40 additions, and the rounding of values that add up to 1.
      const double rounding = precision == Precision::single_precision ? 0x1p-24 : 0;
      EXPECT_NEAR(sum, 1.0, 1.1e-9 + rounding);
    }
    EXPECT_NEAR(report.largest_move, largest, 1e-12);  // differences of values up to 0.1
    EXPECT_NEAR(report.relative_move, std::sqrt(moved / total), 1e-10);
    EXPECT_EQ(reciprocityResidual(matrix), 0.0);
  }
}

TEST(Closure, ResidualsAreReportedFromRowSums) {
  const std::vector<double> sums{1.25, 0.5, 0.0, 1.0};  // the third row sees nothing
  const ClosureReport report = reportClosure(sums, std::vector<double>{1.0, 1.0, 1.0, 1.0});
  EXPECT_EQ(report.largest_residual_before, 0.5);
  EXPECT_DOUBLE_EQ(report.rms_residual_before, std::sqrt((0.0625 + 0.25) / 3));
  EXPECT_EQ(report.largest_residual, 0.0);
  EXPECT_EQ(report.adjustable, 0u);
  EXPECT_FALSE(report.reached);
  const ClosureReport empty = reportClosure({}, {});
  EXPECT_EQ(empty.rms_residual_before, 0.0);
  EXPECT_THROW(reportClosure(sums, std::vector<double>{1.0}), InputError);
}

// Five patches, ten pairs, errors as large as the values: all 1,024 ways to hold some at 0 are
// tried, and the best feasible one is the answer.
TEST(LeastSquaresClosure, HoldsEntriesAtZeroThatWouldTurnNegative) {
  std::size_t with_held = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Scene scene(5, 1.0, 32.0, seed);
    const auto pairs = scene.pairs();
    Vector best;
    for (std::size_t mask = 0; mask < 1024; ++mask) {
      std::vector<bool> held(10);
      for (std::size_t p = 0; p < 10; ++p) held[p] = (mask >> p & 1) != 0;
      const Vector change = leastChange(pairs, scene.lacking(), held);
      Vector rows = scene.lacking();
      bool feasible = true;
      for (std::size_t p = 0; p < 10; ++p) {
        const double moved = change[Eigen::Index(p)] * pairs[p].weight;
        rows[pairs[p].k] -= moved;
        rows[pairs[p].q] -= moved;
        feasible = feasible && pairs[p].raw + moved >= -1e-12;
      }
      feasible = feasible && rows.cwiseAbs().maxCoeff() < 1e-10;
      if (feasible && (best.size() == 0 || change.norm() < best.norm())) best = change;
    }
    ASSERT_GT(best.size(), 0);  // the truth is feasible at least
    SymmetricMatrix matrix = scene.matrix();
    const ClosureReport report =
        closed(matrix, scene.uncertain(), std::vector<double>(5, 1.0), 1e-12);
    EXPECT_TRUE(report.reached) << seed;
    for (std::size_t p = 0; p < 10; ++p) {
      const auto& [k, q, weight, raw] = pairs[p];
      const double f = matrix.at(scene.order[std::size_t(k)], scene.order[std::size_t(q)]);
      EXPECT_GE(f, 0.0);
      const double now = f * scene.area[scene.order[std::size_t(k)]];
      // Closed to 1e-12 of areas of about 2; the smallest error is 32 * 2^-12.
      EXPECT_NEAR((now - raw) / weight, best[Eigen::Index(p)], 1e-8) << seed;
    }
    with_held += report.emptied > 0 ? 1 : 0;
  }
  EXPECT_GT(with_held, 10u);  // else this tests nothing
}

TEST(LeastSquaresClosure, ReportsRowsThatItCannotClose) {
  // Rows 0 and 1 exchange, rows 2 and 3 exchange; only the first pair is uncertain.
  const auto twoPairs = [] {
    return ofRows({{0.0, 0.75}, {}, {0.0, 0.5}, {}}, Precision::double_precision);
  };
  UncertainEntries uncertain(4);
  uncertain.setRow(0, std::vector<Index>{1}, std::vector<double>{0.25});
  SymmetricMatrix other = twoPairs();
  ClosureReport report = closed(other, uncertain, std::vector<double>(4, 1.0));
  EXPECT_FALSE(report.reached);
  EXPECT_EQ(report.fixed_rows, 2u);
  EXPECT_EQ(report.largest_residual, 0.5);
  EXPECT_NEAR(other.at(0, 1), 1.0, 1e-9);
  EXPECT_EQ(other.at(2, 3), 0.5);
  // One value cannot give its two rows different sums: the nearest is the mean.
  SymmetricMatrix uneven = twoPairs();
  report = closed(uneven, uncertain, {0.5, 0.7, 0.5, 0.5});
  EXPECT_FALSE(report.reached);
  EXPECT_EQ(report.fixed_rows, 0u);
  EXPECT_NEAR(report.largest_residual, 0.1, 1e-9);
  EXPECT_NEAR(uneven.at(0, 1), 0.6, 1e-9);
  // Empty rows have nothing to close.
  auto sparse = SymmetricMatrix({1.0, 1.0, 0.0}, {2, 0, 1}, Precision::single_precision);
  sparse.setUpperRow(1, std::vector<double>{0.0, 1.0});
  report = closed(sparse, UncertainEntries(3), std::vector<double>(3, 1.0));
  EXPECT_TRUE(report.reached);
  EXPECT_EQ(report.largest_residual_before, 0.0);
  EXPECT_EQ(report.iterations, 0);
}

TEST(LeastSquaresClosure, ThreadsAndScaleDoNotChangeABit) {
  const Scene scene(700, 0.1, 1.0 / 1024, 5);
  const std::vector<double> target(700, 1.0);
  const auto valuesOf = [&](const Scene& s) {
    SymmetricMatrix matrix = s.matrix(Precision::single_precision);
    const ClosureReport report = closed(matrix, s.uncertain(), target);
    EXPECT_TRUE(report.reached);
    EXPECT_LT(report.iterations, 100);
    std::vector<std::vector<double>> values;
    for (std::size_t k = 0; k < matrix.size(); ++k) {
      matrix.upperRow(k, values.emplace_back(matrix.size() - k));
    }
    return values;
  };
  const std::vector<std::vector<double>> reference = valuesOf(scene);
  for (const int threads : {1, 2, 4}) {
    setThreads(threads);
    EXPECT_EQ(valuesOf(scene), reference);
  }
  setThreads(0);
  for (const int exponent : {-300, 300}) {
    Scene scaled = scene;
    for (double& a : scaled.area) a = std::ldexp(a, exponent);
    EXPECT_EQ(valuesOf(scaled), reference);
  }
}

// Two patches close together have little uncertain but each other: their residual can hardly go
// anywhere else, and an iteration alone takes 396 steps here.
TEST(LeastSquaresClosure, TakesFewStepsIfPatchesSeeMostlyEachOther) {
  constexpr std::size_t kPatches = 300;
  Scene scene(kPatches, 0.2, 1.0 / 1024, 7);
  for (Eigen::Index k = 0; k < Eigen::Index(kPatches); k += 2) {
    scene.error(k, k + 1) = std::exp2(-0.25 * double(k % 40)) / 256;  // others: 2^-15 at most
  }
  SymmetricMatrix matrix = scene.matrix();
  const ClosureReport report =
      closed(matrix, scene.uncertain(), std::vector<double>(kPatches, 1.0));
  EXPECT_TRUE(report.reached) << report.largest_residual;
  // Solved directly, such pairs leave a system with eigenvalues near 1, of some ten steps.
  EXPECT_LE(report.iterations, 20);
}

/// Every entry of a symmetric matrix, the square of its error proportional to its exchange area.
UncertainEntries allOf(const SymmetricMatrix& matrix) {
  UncertainEntries uncertain(matrix.size());
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    std::vector<double> values(matrix.size() - k);
    matrix.upperRow(k, values);
    std::vector<Index> later;
    std::vector<double> errors;
    for (std::size_t m = 1; m < values.size(); ++m) {
      if (values[m] == 0) continue;
      later.push_back(Index(k + m));
      errors.push_back(std::sqrt(values[m] / matrix.area()[matrix.order()[k]]));
    }
    uncertain.setRow(k, later, errors);
  }
  return uncertain;
}

// Patch 0 exchanges with 1 and 2, which see only it: the row sums A_i t_i must balance, and with
// three equal areas they cannot. It stops early and the report says so.
TEST(LeastSquaresClosure, StopsAtRowSumsThatDoNotBalance) {
  auto matrix = ofRows({{0, 0.5, 0.5}, {0, 0}, {0}}, Precision::double_precision);
  const ClosureReport report = closed(matrix, allOf(matrix), std::vector<double>(3, 1.0));
  EXPECT_FALSE(report.reached);
  EXPECT_LT(report.iterations, 200);
  EXPECT_GT(report.largest_residual, 0.2);
  EXPECT_EQ(report.fixed_rows, 0u);
}

// Two plates that see little but each other: the second eigenvalue is -0.96, the slow case.
TEST(LeastSquaresClosure, ClosesNarrowGaps) {
  std::vector<std::vector<double>> upper(40);
  for (std::size_t i = 0; i < 40; ++i) {
    for (std::size_t j = i; j < 40; ++j) {
      const bool same = (i < 20) == (j < 20);
      upper[i].push_back(same ? 0.001 : 0.049 * (1 + 0.3 * std::sin(double(i + j))));
    }
  }
  auto matrix = ofRows(upper, Precision::double_precision);
  const std::vector<double> target(40, 1.0);
  const ClosureReport report = closed(matrix, allOf(matrix), target, 1e-12);
  EXPECT_GT(report.largest_residual_before, 1e-3);
  EXPECT_TRUE(report.reached);
  EXPECT_LE(report.largest_residual, 1.001e-12);  // and rounding
}

// A row that saw nothing but is seen: merging gave it entries, the target removes them.
TEST(LeastSquaresClosure, EmptiesARowOfTargetZero) {
  auto matrix = ofRows({{0, 0.4, 0.2}, {0, 0.1}, {0}}, Precision::single_precision);
  const ClosureReport report = closed(matrix, allOf(matrix), {0.5, 0.5, 0.0});
  EXPECT_TRUE(report.reached);
  EXPECT_LE(matrix.rowSums()[2], 1e-9);
  EXPECT_NEAR(matrix.at(0, 1), 0.5, 3e-8);  // stored in 32 bits
  EXPECT_NEAR(report.largest_move, 0.2, 3e-8);
}

// A row's share beside the matrix is one more pair, with a patch that has no sum to keep.
TEST(LeastSquaresClosure, SharesBesideTheMatrixMoveByTheirErrors) {
  constexpr std::size_t kPatches = 30;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Scene scene(kPatches, 0.4, 1.0 / 64, seed);
    std::vector<Scene::Pair> pairs = scene.pairs();
    std::vector<double> share(kPatches);
    std::vector<double> error(kPatches);
    Matrix rows = Matrix::Zero(Eigen::Index(kPatches), Eigen::Index(pairs.size() + kPatches));
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      rows(pairs[p].k, Eigen::Index(p)) = rows(pairs[p].q, Eigen::Index(p)) = pairs[p].weight;
    }
    for (std::size_t k = 0; k < kPatches; ++k) {
      const Index patch = scene.order[k];
      share[patch] = 0.25;
      error[patch] = std::exp2(-8 - double(k % 5));
      rows(Eigen::Index(k), Eigen::Index(pairs.size() + k)) = scene.area[patch] * error[patch];
    }
    const Vector expected = rows.completeOrthogonalDecomposition().solve(scene.lacking());
    SymmetricMatrix matrix = scene.matrix();
    Progress silent;
    const ClosureReport report =
        closeRows(matrix, scene.uncertain(), std::vector<double>(kPatches, 1.0), silent, 1e-9,
                  {.share = share, .error = error});
    EXPECT_TRUE(report.reached) << seed;
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto& [k, q, weight, raw] = pairs[p];
      const double now = scene.area[scene.order[std::size_t(k)]] *
                         matrix.at(scene.order[std::size_t(k)], scene.order[std::size_t(q)]);
      EXPECT_NEAR((now - raw) / weight, expected[Eigen::Index(p)], 1e-3) << seed;  // as above
    }
  }
}

// A plate with a row sum 10% too large, and two small patches that see it and the sky, known well:
// the sky of the plate has to give way, for the small rows have no room.
TEST(LeastSquaresClosure, ASmallPatchIsNotMadeToSeeMoreThanItsView) {
  const std::vector<double> area{100, 1, 1};
  const auto plateAndTwo = [&] {
    SymmetricMatrix made(area, {0, 1, 2}, Precision::double_precision);
    made.setUpperRow(0, std::vector<double>{0, 0.005, 0.005});
    return made;
  };
  SymmetricMatrix matrix = plateAndTwo();
  UncertainEntries uncertain(3);
  uncertain.setRow(0, std::vector<Index>{1, 2}, std::vector<double>{1e-4, 1e-4});
  const std::vector<double> fronts{0.011, 0.5, 0.5};
  const std::vector<double> sky{0.989, 0.5, 0.5};
  Progress silent;
  SymmetricMatrix without = plateAndTwo();
  EXPECT_FALSE(closeRows(without, uncertain, fronts, silent).reached);
  const ClosureReport report =
      closeRows(matrix, uncertain, fronts, silent, 1e-12,
                {.share = sky, .error = std::vector<double>{1e-3, 1e-3, 1e-3}});
  EXPECT_TRUE(report.reached);
  // By hand, with m_0 and m_1 = m_2: d = (m_0 + m_1) (100 * 1e-4)^2, the plate's sky moves by
  // m_0 (100 * 1e-3)^2, a small one's by m_1 1e-6; 2 d + sky_0 = 0.1, d + sky_1 = 0.
  const Matrix system{{2e-4 + 1e-2, 2e-4}, {1e-4, 1e-4 + 1e-6}};
  const Vector multiplier = system.colPivHouseholderQr().solve(Vector{{0.1, 0.0}});
  // Errors are kept to a quarter of an octave: that of 1e-4 is 0.94e-4 to the next step.
  EXPECT_NEAR(matrix.at(1, 0), 0.5 + 1e-4 * multiplier.sum(), 1e-5);
  EXPECT_LE(matrix.rowSums()[1], 1.0);
}

TEST(LeastSquaresClosure, RefusesSharesThatDoNotFit) {
  auto matrix = ofRows({{0, 0.5}, {0}}, Precision::double_precision);
  const std::vector<double> target(2, 0.5);
  Progress silent;
  const auto with = [&](const std::vector<double>& share, const std::vector<double>& error) {
    closeRows(matrix, allOf(matrix), target, silent, 1e-9, {.share = share, .error = error});
  };
  EXPECT_THROW(with({0.5}, {0.1}), InputError);
  EXPECT_THROW(with({0.5, 0.5}, {0.1}), InputError);
  EXPECT_THROW(with({0.5, -0.5}, {0.1, 0.1}), InputError);
  EXPECT_THROW(with({0.5, 0.5}, {0.1, std::nan("")}), InputError);
}

TEST(UncertainEntries, TakeAByteEach) {
  const std::size_t n = 1000;
  UncertainEntries uncertain(n);
  std::vector<Index> later;
  std::vector<double> errors;
  for (Index q = 10; q < 810; q += q % 100 == 99 ? 41 : 1) {  // stretches of 60 or so
    later.push_back(q);
    errors.push_back(1e-5 * (1 + q % 7));
  }
  for (std::size_t k = 0; k < 9; ++k) uncertain.setRow(k, later, errors);
  EXPECT_EQ(uncertain.entries(), 9 * later.size());
  EXPECT_LE(uncertain.bytes(), 9 * (later.size() + 9 * 4));
  for (int c = 1; c < 256; ++c) {
    const double error = errorOfCode(std::uint8_t(c));
    UncertainEntries one(2);
    one.setRow(0, std::vector<Index>{1}, std::vector<double>{error * 1.08});  // below half a step
    EXPECT_EQ(int(one.row(0).codes[0]), c);
  }
  uncertain.setRow(0, std::vector<Index>{5}, std::vector<double>{0.0});  // known after all
  EXPECT_EQ(uncertain.entries(), 8 * later.size());
}

/// What a patch, or the patches of an unknown, see of themselves is an entry like the others.
TEST(UncertainEntries, TheDiagonalIsClosedToo) {
  auto matrix = SymmetricMatrix({1.0, 1.0}, {0, 1}, Precision::double_precision);
  matrix.setUpperRow(0, std::vector<double>{0.5, 0.3});
  matrix.setUpperRow(1, std::vector<double>{0.7});
  UncertainEntries uncertain(2);
  uncertain.setRow(0, std::vector<Index>{0}, std::vector<double>{0.1});
  EXPECT_EQ(uncertain.entries(), 1u);
  closed(matrix, uncertain, std::vector<double>{1.0, 1.0});
  EXPECT_NEAR(matrix.at(0, 0), 0.7, 1e-12);
  EXPECT_EQ(matrix.at(0, 1), 0.3);
  EXPECT_EQ(matrix.at(1, 1), 0.7);
}

TEST(UncertainEntries, RefuseInvalidErrors) {
  UncertainEntries uncertain(4);
  const auto set = [&](std::size_t k, std::vector<Index> later, std::vector<double> errors) {
    uncertain.setRow(k, later, errors);
  };
  EXPECT_THROW(set(4, {}, {}), InputError);
  EXPECT_THROW(set(0, {1}, {}), InputError);
  EXPECT_THROW(set(1, {0}, {0.1}), InputError);
  EXPECT_THROW(set(0, {4}, {0.1}), InputError);
  EXPECT_THROW(set(0, {2, 1}, {0.1, 0.1}), InputError);
  EXPECT_THROW(set(0, {1}, {-0.1}), InputError);
  EXPECT_THROW(set(0, {1}, {std::nan("")}), InputError);
  EXPECT_THROW(set(0, {1}, {double(INFINITY)}), InputError);
  const std::vector<double> ones(2, 1.0);
  auto matrix = SymmetricMatrix({1.0, 1.0}, {0, 1}, Precision::single_precision);
  EXPECT_THROW(closed(matrix, UncertainEntries(3), ones), InputError);
  EXPECT_THROW(closed(matrix, UncertainEntries(2), {1.0, 1.0, 1.0}), InputError);
  EXPECT_THROW(closed(matrix, UncertainEntries(2), {1.0, -1.0}), InputError);
  EXPECT_THROW(closed(matrix, UncertainEntries(2), {1.0, std::nan("")}), InputError);
}

}  // namespace
}  // namespace radiosity
