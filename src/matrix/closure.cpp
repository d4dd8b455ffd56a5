// Symmetric scaling of a matrix to prescribed row sums.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "radiosity/exchange_matrix.h"

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

/// F_ij <- d_i F_ij d_j, in storage precision; notes how far entries moved.
void scale(ExchangeMatrix& matrix, std::span<const double> d, ClosureReport& report) {
  double moved = 0;
  double total = 0;
  std::vector<Index> columns;
  std::vector<double> values;
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    columns.clear();
    values.clear();
    matrix.forRow(i, [&](Index j, double value) {
      columns.push_back(j);
      values.push_back(d[i] * value * d[j]);
      const double move = values.back() - value;
      report.largest_move = std::max(report.largest_move, std::abs(move));
      moved += matrix.area()[i] * move * move;
      total += matrix.area()[i] * value * value;
    });
    matrix.setRow(i, columns, values);
  }
  report.relative_move = total > 0 ? std::sqrt(moved / total) : 0;
}

}  // namespace

// The row sums of the scaled matrix are s_i = d_i (F d)_i. Scaling by d_i <- d_i sqrt(t_i / s_i)
// halves each row's logarithmic error, as in Knight, Ruiz & Ucar, "A symmetry preserving algorithm
// for matrix scaling" (SIAM J. Matrix Anal. 2014); the square root is what keeps the two ends of a
// pair from each correcting the whole error and oscillating for ever.
ClosureReport restoreClosure(ExchangeMatrix& matrix, std::span<const double> target_row_sums,
                             double tolerance, int max_iterations) {
  const std::size_t n = matrix.size();
  if (target_row_sums.size() != n) {
    throw InputError(fmt::format("closure: {} row sums for {} rows", target_row_sums.size(), n));
  }
  ClosureReport report;
  std::vector<double> d(n, 1.0);
  std::vector<double> sums = matrix.rowSums();
  report.largest_residual_before = largestResidual(matrix, target_row_sums, sums);
  report.largest_residual = report.largest_residual_before;
  while (report.largest_residual > tolerance && report.iterations < max_iterations) {
    for (std::size_t i = 0; i < n; ++i) {
      if (sums[i] > 0) d[i] *= std::sqrt(target_row_sums[i] / sums[i]);
    }
    matrix.product(d, 1, sums);
    for (std::size_t i = 0; i < n; ++i) sums[i] *= d[i];
    report.largest_residual = largestResidual(matrix, target_row_sums, sums);
    ++report.iterations;
  }
  if (report.iterations == 0) return report;
  scale(matrix, d, report);
  report.largest_residual = largestResidual(matrix, target_row_sums, matrix.rowSums());
  return report;
}

}  // namespace radiosity
