// Symmetric scaling of a matrix to prescribed row sums.
#include <cmath>
#include <vector>

#include "matrix/closure_progress.h"
#include "matrix/closure_target.h"
#include "matrix/residual_progress.h"
#include "radiosity/closure.h"

namespace radiosity {

namespace {

double largestResidual(const ExchangeMatrix& matrix, std::span<const double> target,
                       std::span<const double> sums) {
  double largest = 0;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    if (sums[i] > 0) largest = std::max(largest, std::abs(sums[i] - target[i]));
  }
  return largest;
}

/// A run of iterations in which the residual must at least halve. At a slower pace not even
/// thousands reach a usual tolerance: the target is out of reach, as where two groups of patches
/// that see only each other are asked for different exchanged areas.
constexpr std::size_t kPatience = 50;

/// How far entries moved, added up.
struct Moves {
  double largest = 0;
  double moved = 0;
  double total = 0;
  void add(double area, double before, double after) {
    const double move = after - before;
    largest = std::max(largest, std::abs(move));
    moved += area * move * move;
    total += area * before * before;
  }
};

void scaleRows(ExchangeMatrix& matrix, std::span<const double> d, Moves& moves) {
  std::vector<Index> columns;
  std::vector<double> values;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    columns.clear();
    values.clear();
    matrix.forRow(i, [&](Index j, double value) {
      const double scaled = d[i] * value * d[j];
      if (scaled > 0) {
        columns.push_back(j);
        values.push_back(scaled);
      }
      moves.add(matrix.area()[i], value, scaled);
    });
    matrix.setRow(i, columns, values);
  }
}

void scaleTriangle(ExchangeMatrix& matrix, std::span<const double> d, Moves& moves) {
  const std::span<const Index> order = matrix.order();
  const std::span<const double> area = matrix.area();
  std::vector<double> before(matrix.size());
  std::vector<double> after(matrix.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const std::size_t count = order.size() - k;
    matrix.upperRow(k, std::span(before).first(count));
    for (std::size_t m = 0; m < count; ++m) {
      const Index i = order[k];
      const Index j = order[k + m];
      after[m] = d[i] * before[m] * d[j];
      if (before[m] == 0) continue;
      moves.add(area[i], before[m], after[m]);
      const double other_end = area[i] / area[j];
      if (m > 0) moves.add(area[j], before[m] * other_end, after[m] * other_end);
    }
    matrix.setUpperRow(k, std::span(after).first(count));
  }
}

/// F_ij <- d_i F_ij d_j, in storage precision; notes how far entries moved. Entries that become 0
/// (their row or column is to have the sum 0) are no longer stored.
void scale(ExchangeMatrix& matrix, std::span<const double> d, ClosureReport& report) {
  Moves moves;
  if (matrix.isSymmetric()) {
    scaleTriangle(matrix, d, moves);
  } else {
    scaleRows(matrix, d, moves);
  }
  report.largest_move = moves.largest;
  report.relative_move = moves.total > 0 ? std::sqrt(moves.moved / moves.total) : 0;
}

}  // namespace

// The row sums of the scaled matrix are s_i = d_i (F d)_i. Scaling by d_i <- d_i sqrt(t_i / s_i)
// halves each row's logarithmic error, as in Knight, Ruiz & Ucar, "A symmetry preserving algorithm
// for matrix scaling" (SIAM J. Matrix Anal. 2014); the square root is what keeps the two ends of a
// pair from each correcting the whole error and oscillating for ever.
ClosureReport restoreClosure(ExchangeMatrix& matrix, std::span<const double> target_row_sums,
                             Progress& progress, double tolerance, int max_iterations) {
  const std::size_t n = matrix.size();
  checkClosureTarget(target_row_sums, n);
  ClosureReport report;
  std::vector<double> d(n, 1.0);
  std::vector<double> sums = matrix.rowSums();
  report.largest_residual_before = largestResidual(matrix, target_row_sums, sums);
  report.largest_residual = report.largest_residual_before;
  ResidualProgress shown(progress, "closure", report.largest_residual_before, tolerance);
  std::vector<double> history;
  const auto stalls = [&] {
    return history.size() > kPatience &&
           history.back() > 0.5 * history[history.size() - 1 - kPatience];
  };
  while (report.largest_residual > tolerance && report.iterations < max_iterations && !stalls()) {
    for (std::size_t i = 0; i < n; ++i) {
      if (sums[i] > 0) d[i] *= std::sqrt(target_row_sums[i] / sums[i]);
    }
    matrix.product(d, 1, sums);
    for (std::size_t i = 0; i < n; ++i) sums[i] *= d[i];
    report.largest_residual = largestResidual(matrix, target_row_sums, sums);
    history.push_back(report.largest_residual);
    shown.at(report.largest_residual);
    ++report.iterations;
  }
  if (report.iterations > 0) {
    scale(matrix, d, report);
    report.largest_residual = largestResidual(matrix, target_row_sums, matrix.rowSums());
  }
  report.reached = report.largest_residual <= tolerance;
  shown.end();
  return report;
}

ClosureReport restoreClosure(ExchangeMatrix& matrix, std::span<const double> target_row_sums,
                             double tolerance, int max_iterations) {
  Progress silent;
  return restoreClosure(matrix, target_row_sums, silent, tolerance, max_iterations);
}

}  // namespace radiosity
