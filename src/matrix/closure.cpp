// Closure as weighted least squares with a multiplier a row.
#include "radiosity/closure.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory_resource>
#include <numeric>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/scratch_rows.h"
#include "matrix/conjugate_residuals.h"
#include "matrix/residual_progress.h"
#include "matrix/run_row.h"
#include "matrix/strong_pairs.h"
#include "matrix/triangle_pass.h"
#include "matrix/uncertain_row.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

namespace {

constexpr std::size_t kClosureGrain = 16;
/// The most Newton steps. One is needed if no entry turns negative, else a handful.
constexpr int kMostRounds = 30;
/// While entries reach 0 or leave it, each step is solved to this share of the rows' shortfall:
/// such entries would spoil a more exact step (inexact Newton: Dembo, Eisenstat & Steihaug, SIAM J.
/// Numer. Anal. 19, 1982). If the last step held and freed no entry, the next is solved to the
/// tolerance.
constexpr double kForcing = 0.1;
/// The shortest part of a Newton step that we try.
constexpr double kShortestStep = 1e-6;
/// Once entries are held at 0, each row's own weight grows by this factor times the largest
/// shortfall. A row without free entries can then still recover.
constexpr double kDamping = 1e-2;

/// The problem, by position. Let e_kq be the error of F_kq and w_kq = (A_k e_kq)^2 the squared
/// error of the exchange area. The least sum of d_kq^2 / (2 w_kq) over pairs with sum_q d_kq = r_k
/// and d_kq >= -G_kq has
///     d_kq = max(-G_kq, w_kq (m_k + m_q))
/// with a multiplier m per row (the conditions of Karush, Kuhn and Tucker). The m minimise the dual
///     f(m) = sum over pairs of phi_kq(m_k + m_q) - sum_k r_k m_k,   phi' = d,
/// which is convex and piecewise quadratic. Its gradient is the negative shortfall of the rows. One
/// Newton step solves
///     (D + W) step = shortfall,   D_k = sum_q w_kq over the entries that are not at 0,
/// which is symmetric and positive semi-definite. If no entry turns negative, one step suffices.
///
/// The diagonal and the share of a row beside the matrix are entries that no other row has: d_k =
/// max(-A_k f_k, w_k m_k) with their value f_k and w_k = (A_k e_k)^2.
class LeastSquaresClosure {
 public:
  LeastSquaresClosure(SymmetricMatrix& matrix, const UncertainEntries& uncertain,
                      std::span<const double> target, const SharesBeside& beside,
                      Progress& progress);

  void findMultipliers(double tolerance);
  /// Changes the matrix according to the multipliers.
  void apply();
  /// Residuals and moves before and after.
  ClosureReport report(double tolerance) const;

 private:
  template <class Visit>
  void forUncertain(std::size_t k, const Visit& visit) const;
  std::pmr::vector<std::uint8_t>& freeOf(std::size_t k);
  std::vector<double> timesWeights(const std::vector<double>& x);
  StrongPairs strongPairs(const std::vector<double>& own);
  std::vector<double> weightsOfRows();
  void evaluate();
  double largestLack() const;
  std::vector<double> scaledDiagonal();
  std::vector<double> newtonStep(double tolerance);

  SymmetricMatrix& matrix_;
  const UncertainEntries& uncertain_;
  Progress& progress_;
  TrianglePass pass_;
  std::array<double, 256> squared_{};  // e^2 by code
  std::vector<double> area_;           // in a unit that keeps its squares in range
  // Like uncertain_.row(k).codes, but 0 for entries held at 0:
  std::vector<std::pmr::vector<std::uint8_t>> free_;
  /// An entry that no other row has.
  struct Alone {
    double value = 0;
    double squared_error = 0;
    bool held = false;
  };
  std::vector<Alone> diagonal_;    // N
  std::vector<Alone> beside_;      // N, or none
  std::vector<double> goal_;       // the target sum of each row
  std::vector<double> shortfall_;  // goal - row sum before
  std::vector<double> root_;       // of D while all are free
  std::vector<double> multiplier_;
  // Set by evaluate() for the current multipliers:
  std::vector<double> lacking_;  // goal - row sum after
  double dual_ = 0;              // f
  std::size_t held_ = 0;         // entries at 0
  std::size_t turned_ = 0;       // entries that were held or freed
  ClosureReport report_;
};

LeastSquaresClosure::LeastSquaresClosure(SymmetricMatrix& matrix, const UncertainEntries& uncertain,
                                         std::span<const double> target, const SharesBeside& beside,
                                         Progress& progress)
    : matrix_(matrix),
      uncertain_(uncertain),
      progress_(progress),
      pass_(matrix.size(), 1, [&](std::size_t k) { return uncertain.row(k).codes.size() + 1; }),
      area_(matrix.size()),
      diagonal_(matrix.size()),
      beside_(beside.share.size()),
      goal_(matrix.size()),
      shortfall_(matrix.size()),
      multiplier_(matrix.size(), 0.0) {
  for (std::size_t c = 1; c < squared_.size(); ++c) {
    const double error = errorOfCode(std::uint8_t(c));
    squared_[c] = error * error;
  }
  const std::vector<double> sums = matrix.rowSums();
  report_ = reportClosure(sums, target);
  const std::span<const double> area = matrix.area();
  double largest = 0;
  for (const double a : area) largest = std::max(largest, a);
  const int exponent = largest > 0 ? std::ilogb(largest) : 0;
  free_.reserve(matrix.size());
  for (std::size_t k = 0; k < matrix.size(); ++k) {
    const Index patch = matrix.order()[k];
    const auto& codes = uncertain.row(k).codes;
    free_.emplace_back(codes, codes.get_allocator());
    area_[k] = std::ldexp(area[patch], -exponent);
    // A row that sums to 0 sees nothing or has no area: it keeps this sum.
    goal_[k] = sums[patch] > 0 ? target[patch] : 0.0;
    shortfall_[k] = goal_[k] - sums[patch];
    diagonal_[k] = {matrix.diagonal(k), squared_[uncertain.row(k).own]};
    if (beside_.empty() || !(sums[patch] > 0)) continue;
    beside_[k] = {beside.share[patch], beside.error[patch] * beside.error[patch]};
  }
  report_.adjustable = uncertain.entries();
  root_ = weightsOfRows();
  for (double& d : root_) d = std::sqrt(d);
  // The shortfall as long as no entry is changed.
  lacking_ = shortfall_;
}

/// Calls visit(index into the row's codes, position, code, F) for the uncertain entries of row k.
template <class Visit>
void LeastSquaresClosure::forUncertain(std::size_t k, const Visit& visit) const {
  const UncertainEntries::Row& row = uncertain_.row(k);
  RunReader stored(matrix_.upperRuns(k));
  std::size_t index = 0;
  forRuns(std::span<const Run>(row.runs), row.codes.data(),
          [&](std::size_t offset, const std::uint8_t* codes, std::size_t count) {
            for (std::size_t m = 0; m < count; ++m, ++index) {
              if (codes[m] == 0) continue;
              visit(index, k + 1 + offset + m, codes[m], stored.at(offset + m));
            }
          });
}

std::pmr::vector<std::uint8_t>& LeastSquaresClosure::freeOf(std::size_t k) {
  touchRows(uncertain_.scratch().get(), free_[k].size());
  return free_[k];
}

/// W x over the free entries.
std::vector<double> LeastSquaresClosure::timesWeights(const std::vector<double>& x) {
  std::vector<double> out(x.size());
  const auto row = [&](std::size_t k, double* scattered, std::size_t) {
    const double squared_area = area_[k] * area_[k];
    const double own = squared_area * x[k];
    const double* later = x.data() + k + 1;
    double gathered = 0;
    forRuns(std::span<const Run>(uncertain_.row(k).runs), freeOf(k).data(),
            [&](std::size_t offset, const std::uint8_t* codes, std::size_t count) {
              for (std::size_t m = 0; m < count; ++m) {
                const double squared = squared_[codes[m]];
                gathered += squared * later[offset + m];
                scattered[offset + m] += squared * own;
              }
            });
    out[k] = squared_area * gathered;
  };
  pass_.run(1, row, [&](std::size_t k, const double* handed) { out[k] += handed[0]; });
  return out;
}

/// The diagonal D.
std::vector<double> LeastSquaresClosure::weightsOfRows() {
  std::vector<double> sums = timesWeights(std::vector<double>(area_.size(), 1.0));
  for (const std::vector<Alone>* alone : {&diagonal_, &beside_}) {
    for (std::size_t k = 0; k < alone->size(); ++k) {
      const Alone& entry = (*alone)[k];
      if (!entry.held) sums[k] += area_[k] * area_[k] * entry.squared_error;
    }
  }
  return sums;
}

/// The strong pairs of D + W, scaled by the root of D. `own`: its diagonal.
StrongPairs LeastSquaresClosure::strongPairs(const std::vector<double>& own) {
  std::vector<std::vector<StrongPairs::Pair>> of_row(own.size());
  std::vector<double> diagonal = own;
  parallelFor(own.size(), kClosureGrain, [&](std::size_t k) {
    if (!(root_[k] > 0)) {
      diagonal[k] = 1;
      return;
    }
    const double scale = area_[k] * area_[k] / root_[k];
    forRuns(std::span<const Run>(uncertain_.row(k).runs), freeOf(k).data(),
            [&](std::size_t offset, const std::uint8_t* codes, std::size_t count) {
              for (std::size_t m = 0; m < count; ++m) {
                const std::size_t later = k + 1 + offset + m;
                const double value = scale * squared_[codes[m]];
                if (value <= 0 || value < StrongPairs::kStrong * root_[later]) continue;
                of_row[k].push_back({Index(k), Index(later), value / root_[later]});
              }
            });
  });
  std::vector<StrongPairs::Pair> pairs;
  for (const auto& row : of_row) pairs.insert(pairs.end(), row.begin(), row.end());
  return {diagonal, pairs};
}

/// Evaluates the multipliers: f, the shortfall of each row, and which entries are free or at 0.
void LeastSquaresClosure::evaluate() {
  const std::size_t n = area_.size();
  std::vector<std::size_t> emptied(n, 0);
  std::vector<std::size_t> turned(n, 0);
  std::vector<double> value(n, 0.0);
  lacking_ = shortfall_;
  // Changes an entry of row k by the sum of its multipliers. Returns the change, and whether the
  // entry is held at 0.
  const auto move = [&](std::size_t k, double f, double squared_error, double sum, bool was_held) {
    const double slope = area_[k] * squared_error;  // of the change of F
    const bool held = slope * sum < -f;
    const double change = held ? -f : slope * sum;
    turned[k] += held != was_held ? 1 : 0;
    lacking_[k] -= change;
    value[k] += area_[k] * (held ? -f * sum - f * f / (2 * slope) : change * sum / 2);
    return std::pair(change, held);
  };
  const auto row = [&](std::size_t k, double* scattered, std::size_t) {
    std::pmr::vector<std::uint8_t>& free = freeOf(k);
    forUncertain(k, [&](std::size_t index, std::size_t later, std::uint8_t code, double f) {
      const double sum = multiplier_[k] + multiplier_[later];
      const auto [change, held] = move(k, f, squared_[code], sum, free[index] == 0);
      free[index] = held ? std::uint8_t(0) : code;
      emptied[k] += held ? 1 : 0;
      scattered[later - k - 1] += area_[k] * change;
    });
    const auto moveAlone = [&](Alone& entry) {
      if (!(entry.squared_error > 0)) return;
      entry.held = move(k, entry.value, entry.squared_error, multiplier_[k], entry.held).second;
    };
    moveAlone(diagonal_[k]);
    emptied[k] += diagonal_[k].held ? 1 : 0;
    if (!beside_.empty()) moveAlone(beside_[k]);
    value[k] -= area_[k] * shortfall_[k] * multiplier_[k];
  };
  pass_.run(1, row, [&](std::size_t k, const double* handed) {
    if (area_[k] > 0) lacking_[k] -= handed[0] / area_[k];
  });
  report_.emptied = std::accumulate(emptied.begin(), emptied.end(), std::size_t(0));
  held_ = report_.emptied + std::size_t(std::ranges::count(beside_, true, &Alone::held));
  turned_ = std::accumulate(turned.begin(), turned.end(), std::size_t(0));
  dual_ = std::accumulate(value.begin(), value.end(), 0.0);
}

/// D over the square of root_, plus the damping of the step: 1 while all entries are free.
std::vector<double> LeastSquaresClosure::scaledDiagonal() {
  std::vector<double> own(area_.size(), 1.0);
  if (held_ == 0) return own;
  const double damping = kDamping * largestLack();
  own = weightsOfRows();
  for (std::size_t k = 0; k < own.size(); ++k) {
    own[k] = root_[k] > 0 ? own[k] / (root_[k] * root_[k]) + damping : 0;
  }
  return own;
}

/// Solves on the system scaled by the root of D from both sides, with strong pairs solved directly.
/// The matrix is singular if a set of rows shares uncertain entries only with another set.
std::vector<double> LeastSquaresClosure::newtonStep(double tolerance) {
  const std::size_t n = area_.size();
  const std::vector<double> own = scaledDiagonal();
  const auto multiply = [&](const std::vector<double>& x) {
    std::vector<double> scaled(n);
    for (std::size_t k = 0; k < n; ++k) scaled[k] = root_[k] > 0 ? x[k] / root_[k] : 0;
    std::vector<double> out = timesWeights(scaled);
    for (std::size_t k = 0; k < n; ++k) {
      out[k] = root_[k] > 0 ? own[k] * x[k] + out[k] / root_[k] : 0;
    }
    return out;
  };
  std::vector<double> right(n);
  for (std::size_t k = 0; k < n; ++k) {
    right[k] = root_[k] > 0 ? area_[k] * lacking_[k] / root_[k] : 0;
  }
  const auto largest = [&](const std::vector<double>& residual) {
    double most = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (root_[k] > 0) most = std::max(most, std::abs(residual[k]) * root_[k] / area_[k]);
    }
    return most;
  };
  const StrongPairs strong = strongPairs(own);
  std::vector<double> x = conjugateResiduals({multiply, largest, strong}, std::move(right),
                                             tolerance, progress_, report_.iterations);
  for (std::size_t k = 0; k < n; ++k) x[k] = root_[k] > 0 ? x[k] / root_[k] : 0;
  return x;
}

/// The largest shortfall of a row that has a free entry.
double LeastSquaresClosure::largestLack() const {
  double largest = 0;
  for (std::size_t k = 0; k < area_.size(); ++k) {
    if (root_[k] > 0) largest = std::max(largest, std::abs(lacking_[k]));
  }
  return largest;
}

void LeastSquaresClosure::findMultipliers(double tolerance) {
  ResidualProgress shown(progress_, "closure", largestLack(), tolerance);
  for (int round = 0; round < kMostRounds && largestLack() > tolerance; ++round) {
    shown.at(largestLack());
    const bool settled = round > 0 && turned_ == 0;
    const std::vector<double> step =
        newtonStep(settled ? tolerance : std::max(tolerance, kForcing * largestLack()));
    const std::vector<double> start = multiplier_;
    const double dual = dual_;
    const double lack = largestLack();
    // Near the end f changes by less than its rounding, so we also look at the rows themselves.
    const auto better = [&] { return dual_ < dual || largestLack() < lack / 2; };
    for (double part = 1; part >= kShortestStep; part /= 2) {
      progress_.check();
      for (std::size_t k = 0; k < step.size(); ++k) multiplier_[k] = start[k] + part * step[k];
      evaluate();
      if (better()) break;
    }
    if (better()) continue;
    multiplier_ = start;
    evaluate();
    break;
  }
  shown.end();
}

void LeastSquaresClosure::apply() {
  const std::size_t n = area_.size();
  const double squares = weightedSquares(matrix_);
  const bool single = matrix_.precision() == Precision::single_precision;
  std::vector<double> largest(n, 0.0);
  std::vector<double> moved(n, 0.0);
  parallelFor(n, kClosureGrain, [&](std::size_t k) {
    const UncertainEntries::Row& uncertain = uncertain_.row(k);
    if (uncertain.own == 0 && uncertain.runs.empty()) return;
    const SymmetricMatrix::UpperEntries before = matrix_.upperEntries(k);
    SymmetricMatrix::UpperEntries after;
    std::size_t next = 0;
    const auto keepBelow = [&](std::size_t position) {
      for (; next < before.positions.size() && before.positions[next] < position; ++next) {
        after.positions.push_back(before.positions[next]);
        after.factors.push_back(before.factors[next]);
      }
    };
    // Returns the change of an entry.
    const auto move = [&](std::size_t later, double f, double squared_error, double sum) {
      keepBelow(later);
      if (f != 0) ++next;
      double value = std::max(0.0, f + area_[k] * squared_error * sum);
      if (single) value = double(float(value));
      after.positions.push_back(Index(later));
      after.factors.push_back(value);
      return value - f;
    };
    if (uncertain.own != 0) {
      const Alone& own = diagonal_[k];
      const double change = move(k, own.value, own.squared_error, multiplier_[k]);
      largest[k] = std::abs(change);
      moved[k] = change * change;
    }
    forUncertain(k, [&](std::size_t, std::size_t later, std::uint8_t code, double f) {
      const double change = move(later, f, squared_[code], multiplier_[k] + multiplier_[later]);
      if (change == 0) return;
      const double other_end = area_[k] / area_[later];
      largest[k] = std::max(largest[k], std::abs(change) * std::max(1.0, other_end));
      moved[k] += change * change * (1 + other_end);
    });
    keepBelow(n);
    matrix_.setUpperRow(k, after.positions, after.factors);
  });
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) {
    report_.largest_move = std::max(report_.largest_move, largest[k]);
    sum += matrix_.area()[matrix_.order()[k]] * moved[k];
  }
  report_.relative_move = squares > 0 ? std::sqrt(sum / squares) : 0;
}

ClosureReport LeastSquaresClosure::report(double tolerance) const {
  ClosureReport report = report_;
  const bool single = matrix_.precision() == Precision::single_precision;
  const double rounding = single ? std::numeric_limits<float>::epsilon() / 2
                                 : std::numeric_limits<double>::epsilon() / 2;
  const std::vector<double> sums = matrix_.rowSums();
  report.reached = true;
  for (std::size_t k = 0; k < area_.size(); ++k) {
    double beside = 0;
    if (!beside_.empty()) {
      beside = std::max(-beside_[k].value, area_[k] * beside_[k].squared_error * multiplier_[k]);
    }
    const double residual = std::abs(sums[matrix_.order()[k]] + beside - goal_[k]);
    report.largest_residual = std::max(report.largest_residual, residual);
    const bool off = residual > tolerance + rounding * goal_[k];
    if (off) report.reached = false;
    if (off && root_[k] == 0) ++report.fixed_rows;
  }
  return report;
}

void checkTarget(std::span<const double> target, std::size_t n) {
  if (target.size() != n) {
    throw InputError(fmt::format("closure: {} row sums for {} rows", target.size(), n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!(target[i] >= 0) || !std::isfinite(target[i])) {
      throw InputError(fmt::format("closure: {} is no sum for row {}", target[i], i));
    }
  }
}

void checkBeside(const SharesBeside& beside, std::size_t n) {
  const auto usable = [](double x) { return x >= 0 && std::isfinite(x); };
  const bool fits = beside.share.size() == beside.error.size() &&
                    (beside.share.empty() || beside.share.size() == n) &&
                    std::ranges::all_of(beside.share, usable) &&
                    std::ranges::all_of(beside.error, usable);
  if (!fits)
    throw InputError(fmt::format("closure: shares beside the matrix do not fit {} rows", n));
}

}  // namespace

ClosureReport reportClosure(std::span<const double> row_sums,
                            std::span<const double> target_row_sums) {
  checkTarget(target_row_sums, row_sums.size());
  ClosureReport report;
  std::size_t rows = 0;
  double squares = 0;
  for (std::size_t i = 0; i < row_sums.size(); ++i) {
    if (!(row_sums[i] > 0)) continue;
    const double residual = row_sums[i] - target_row_sums[i];
    report.largest_residual_before = std::max(report.largest_residual_before, std::abs(residual));
    squares += residual * residual;
    ++rows;
  }
  if (rows > 0) report.rms_residual_before = std::sqrt(squares / double(rows));
  return report;
}

ClosureReport closeRows(SymmetricMatrix& matrix, const UncertainEntries& uncertain,
                        std::span<const double> target_row_sums, Progress& progress,
                        double tolerance, const SharesBeside& beside) {
  checkTarget(target_row_sums, matrix.size());
  checkBeside(beside, matrix.size());
  if (uncertain.size() != matrix.size()) {
    throw InputError(fmt::format("closure: uncertain entries of {} rows for a matrix of {}",
                                 uncertain.size(), matrix.size()));
  }
  LeastSquaresClosure closure(matrix, uncertain, target_row_sums, beside, progress);
  // Half of the tolerance is left for the rounding of stored values.
  closure.findMultipliers(tolerance / 2);
  closure.apply();
  return closure.report(tolerance);
}

}  // namespace radiosity
