// Closure by least squares against dense linear algebra, and what a correction does to a matrix.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "radiosity/closure.h"

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

  ExchangeMatrix matrix(Precision precision = Precision::real) const {
    auto matrix = ExchangeMatrix::symmetric(area, order, precision);
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
  /// What the rows lack, as exchange areas.
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

TEST(LeastSquaresClosure, IsTheLeastChange) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Scene scene(30, 0.4, 1.0 / 64, seed);
    ExchangeMatrix matrix = scene.matrix();
    const ClosureReport report =
        closeRows(matrix, scene.uncertain(), std::vector<double>(30, 1.0), true);
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

TEST(LeastSquaresClosure, TouchesNothingThatIsKnown) {
  const Scene scene(40, 0.3, 1.0 / 64, 3);
  for (const Precision precision : {Precision::single, Precision::real}) {
    ExchangeMatrix matrix = scene.matrix(precision);
    const ExchangeMatrix before = matrix;
    const ClosureReport report =
        closeRows(matrix, scene.uncertain(), std::vector<double>(40, 1.0), true);
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
      EXPECT_NEAR(sum, 1.0, 1.1e-9);  // the tolerance, and 40 additions
    }
    EXPECT_NEAR(report.largest_move, largest, 1e-12);  // differences of values up to 0.1
    EXPECT_NEAR(report.relative_move, std::sqrt(moved / total), 1e-10);
    EXPECT_EQ(reciprocityResidual(matrix), 0.0);
  }
}

TEST(LeastSquaresClosure, ReportAloneChangesNothing) {
  const Scene scene(40, 0.3, 1.0 / 64, 4);
  ExchangeMatrix reported = scene.matrix(Precision::single);
  ExchangeMatrix enforced = reported;
  const std::vector<double> target(40, 1.0);
  const ClosureReport a = closeRows(reported, scene.uncertain(), target, false);
  const ClosureReport b = closeRows(enforced, scene.uncertain(), target, true);
  EXPECT_FALSE(reported.isCorrected());
  EXPECT_TRUE(enforced.isCorrected());
  // Reported to 1% of the residual, which moves are proportional to.
  EXPECT_NEAR(a.largest_move, b.largest_move, 0.05 * b.largest_move);
  EXPECT_NEAR(a.relative_move, b.relative_move, 0.05 * b.relative_move);
  EXPECT_LE(a.largest_residual, 0.01 * a.largest_residual_before);
  EXPECT_EQ(a.largest_residual_before, b.largest_residual_before);
  EXPECT_LE(a.iterations, b.iterations);
  const auto same = [](const std::vector<double>& x, const std::vector<double>& y) {
    return x == y;
  };
  EXPECT_TRUE(same(reported.rowSums(), enforced.rowSums(Part::raw)));
}

// Five patches, ten pairs, errors as large as the values: all 1,024 ways to hold some at 0 are
// tried, and the best one that is feasible is the answer.
TEST(LeastSquaresClosure, HoldsAtZeroWhatWouldTurnNegative) {
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
    ASSERT_GT(best.size(), 0);  // the truth is feasible, so that something is
    ExchangeMatrix matrix = scene.matrix();
    const ClosureReport report =
        closeRows(matrix, scene.uncertain(), std::vector<double>(5, 1.0), true, 1e-12);
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

TEST(LeastSquaresClosure, SaysWhatIsOutOfReach) {
  // Rows 0 and 1 exchange, rows 2 and 3 exchange; only the first pair is uncertain.
  auto matrix = ExchangeMatrix::symmetric({1.0, 1.0, 1.0, 1.0}, {0, 1, 2, 3}, Precision::real);
  matrix.setUpperRow(0, std::vector<double>{0.0, 0.75});
  matrix.setUpperRow(2, std::vector<double>{0.0, 0.5});
  UncertainEntries uncertain(4);
  uncertain.setRow(0, std::vector<Index>{1}, std::vector<double>{0.25});
  ExchangeMatrix closed = matrix;
  ClosureReport report = closeRows(closed, uncertain, std::vector<double>(4, 1.0), true);
  EXPECT_FALSE(report.reached);
  EXPECT_EQ(report.fixed_rows, 2u);
  EXPECT_EQ(report.largest_residual, 0.5);
  EXPECT_NEAR(closed.at(0, 1), 1.0, 1e-9);
  EXPECT_EQ(closed.at(2, 3), 0.5);
  // One value cannot give its two rows different sums: the nearest is the mean.
  closed = matrix;
  report = closeRows(closed, uncertain, std::vector<double>{0.5, 0.7, 0.5, 0.5}, true);
  EXPECT_FALSE(report.reached);
  EXPECT_EQ(report.fixed_rows, 0u);
  EXPECT_NEAR(report.largest_residual, 0.1, 1e-9);
  EXPECT_NEAR(closed.at(0, 1), 0.6, 1e-9);
  // Empty rows are asked for nothing.
  auto sparse = ExchangeMatrix::symmetric({1.0, 1.0, 0.0}, {2, 0, 1}, Precision::single);
  sparse.setUpperRow(1, std::vector<double>{0.0, 1.0});
  report = closeRows(sparse, UncertainEntries(3), std::vector<double>(3, 1.0), true);
  EXPECT_TRUE(report.reached);
  EXPECT_EQ(report.largest_residual_before, 0.0);
  EXPECT_EQ(report.iterations, 0);
}

TEST(LeastSquaresClosure, ThreadsAndScaleDoNotChangeABit) {
  const Scene scene(700, 0.1, 1.0 / 1024, 5);
  const std::vector<double> target(700, 1.0);
  const auto closed = [&](const Scene& s) {
    ExchangeMatrix matrix = s.matrix(Precision::single);
    const ClosureReport report = closeRows(matrix, s.uncertain(), target, true);
    EXPECT_TRUE(report.reached);
    EXPECT_LT(report.iterations, 100);
    return matrix.rowSums(Part::correction);
  };
  const std::vector<double> reference = closed(scene);
  for (const int threads : {1, 2, 4}) {
    setThreads(threads);
    EXPECT_EQ(closed(scene), reference);
  }
  setThreads(0);
  for (const int exponent : {-300, 300}) {
    Scene scaled = scene;
    for (double& a : scaled.area) a = std::ldexp(a, exponent);
    EXPECT_EQ(closed(scaled), reference);
  }
}

TEST(Correction, EveryReaderSeesTheSum) {
  const Scene scene(60, 0.3, 1.0 / 64, 6);
  ExchangeMatrix matrix = scene.matrix(Precision::single);
  closeRows(matrix, scene.uncertain(), std::vector<double>(60, 1.0), true);
  const auto dense = [&](Part part) {
    Matrix f = Matrix::Zero(60, 60);
    matrix.forPanels(
        [&](const RowPanel& panel) {
          for (std::size_t i = panel.first(); i < panel.last(); ++i) {
            panel.forRow(i, [&](Index j, double value) { f(Eigen::Index(i), j) = value; });
          }
        },
        part);
    return f;
  };
  const Matrix raw = dense(Part::raw);
  const Matrix change = dense(Part::correction);
  const Matrix sum = dense(Part::corrected);
  EXPECT_GT(change.cwiseAbs().maxCoeff(), 1e-6);
  // Mirrored values are rounded once in the sum, twice in the parts.
  EXPECT_LT((sum - raw - change).cwiseAbs().maxCoeff(), 1e-16);
  for (Index i = 0; i < 60; ++i) {
    for (Index j = 0; j < 60; ++j) EXPECT_EQ(matrix.at(i, j), sum(i, j));
  }
  EXPECT_EQ(matrix.nonZeros(), std::size_t((sum.array() != 0).count()));
  EXPECT_EQ(matrix.nonZeros(Part::correction), std::size_t((change.array() != 0).count()));
  std::vector<double> x(60 * 5);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = 1 + 0.5 * std::sin(double(k));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor given = Eigen::Map<const RowMajor>(x.data(), 60, 5);
  for (const Part part : {Part::raw, Part::correction, Part::corrected}) {
    std::vector<double> y(x.size());
    matrix.productOf(part, x, 5, y);
    const RowMajor expected = dense(part) * given;
    // 60 terms up to 0.1 in another order.
    for (std::size_t k = 0; k < y.size(); ++k) EXPECT_NEAR(y[k], expected.data()[k], 1e-14);
    double squares = 0;
    for (Index i = 0; i < 60; ++i) squares += scene.area[i] * dense(part).row(i).squaredNorm();
    EXPECT_NEAR(weightedSquares(matrix, part), squares, 1e-12 * squares);
  }
  RowMajor now = given;
  matrix.sweep(x, 5, [&](std::size_t i, const double* gathered) {
    const RowMajor expected = sum.row(Eigen::Index(i)) * now;
    for (std::size_t b = 0; b < 5; ++b) {
      EXPECT_NEAR(gathered[b], expected(0, Eigen::Index(b)), 1e-14);
      x[i * 5 + b] = now(Eigen::Index(i), Eigen::Index(b)) = 0.5 * gathered[b];
    }
  });
  EXPECT_THROW(matrix.setUpperRow(0, {}), InputError);
  matrix.setCorrection({});
  EXPECT_FALSE(matrix.isCorrected());
  EXPECT_EQ(matrix.at(3, 9), raw(3, 9));
}

TEST(Correction, MayNotTurnAValueNegative) {
  auto matrix = ExchangeMatrix::symmetric({1.0, 1.0}, {0, 1}, Precision::single);
  matrix.setUpperRow(0, std::vector<double>{0.0, 0.25});
  std::vector<RunRow> changes(2);
  changes[0] = {{{0, 1}}, {-0.5f}, {}};
  EXPECT_THROW(matrix.setCorrection(changes), InputError);
  changes[0] = {{{1, 1}}, {0.5f}, {}};  // beyond the last column
  EXPECT_THROW(matrix.setCorrection(changes), InputError);
  EXPECT_THROW(matrix.setCorrection(std::vector<RunRow>(1)), InputError);
  EXPECT_FALSE(matrix.isCorrected());
  changes[0] = {{{0, 1}}, {-0.25f}, {}};
  matrix.setCorrection(changes);
  EXPECT_EQ(matrix.at(0, 1), 0.0);
  EXPECT_EQ(matrix.nonZeros(), 0u);
  ExchangeMatrix rows({1.0, 1.0}, Precision::single);
  EXPECT_THROW(rows.setCorrection(changes), InputError);
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
    const double error = UncertainEntries::errorOf(std::uint8_t(c));
    UncertainEntries one(2);
    one.setRow(0, std::vector<Index>{1}, std::vector<double>{error * 1.08});  // below half a step
    EXPECT_EQ(int(one.row(0).codes[0]), c);
  }
  uncertain.setRow(0, std::vector<Index>{5}, std::vector<double>{0.0});  // known after all
  EXPECT_EQ(uncertain.entries(), 8 * later.size());
}

TEST(UncertainEntries, RefusesWhatIsNoError) {
  UncertainEntries uncertain(4);
  const auto set = [&](std::size_t k, std::vector<Index> later, std::vector<double> errors) {
    uncertain.setRow(k, later, errors);
  };
  EXPECT_THROW(set(4, {}, {}), InputError);
  EXPECT_THROW(set(0, {1}, {}), InputError);
  EXPECT_THROW(set(1, {1}, {0.1}), InputError);
  EXPECT_THROW(set(0, {4}, {0.1}), InputError);
  EXPECT_THROW(set(0, {2, 1}, {0.1, 0.1}), InputError);
  EXPECT_THROW(set(0, {1}, {-0.1}), InputError);
  EXPECT_THROW(set(0, {1}, {std::nan("")}), InputError);
  EXPECT_THROW(set(0, {1}, {double(INFINITY)}), InputError);
  ExchangeMatrix rows({1.0, 1.0}, Precision::single);
  EXPECT_THROW(closeRows(rows, UncertainEntries(2), std::vector<double>(2, 1.0), true), InputError);
  auto matrix = ExchangeMatrix::symmetric({1.0, 1.0}, {0, 1}, Precision::single);
  EXPECT_THROW(closeRows(matrix, UncertainEntries(3), std::vector<double>(2, 1.0), true),
               InputError);
  EXPECT_THROW(closeRows(matrix, UncertainEntries(2), std::vector<double>(3, 1.0), true),
               InputError);
  const std::vector<double> one_sum(1, 1.0);
  EXPECT_THROW(
      closeRows(matrix, {one_sum, 1.0}, UncertainEntries(2), std::vector<double>(2, 1.0), true),
      InputError);
}

}  // namespace
}  // namespace radiosity
