// Reciprocity, A_i F_ij = A_j F_ji: measures its error in a matrix and enforces it.
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "matrix/both_estimates.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

namespace {

/// A_other^2 / (A_own^2 + A_other^2), safe from overflow. The bias of a one-point estimate at a
/// patch grows as the patch's area over the squared distance, so the squared error of the estimate
/// at the other end grows as the other's area squared. The weights are the inverse squared errors.
double estimateWeight(double own_area, double other_area) {
  const double ratio = own_area / other_area;
  return 1 / (1 + ratio * ratio);
}

}  // namespace

double reciprocityResidual(const ExchangeMatrix& matrix) {
  if (matrix.isSymmetric()) return 0;
  const std::span<const double> area = matrix.area();
  std::vector<double> difference(matrix.size());  // by row, summed in order at the end, so that
  std::vector<double> total(matrix.size());       // any thread count gives the same bits
  forBothEstimates(matrix, [&](std::size_t i, auto row, auto column) {
    for (std::size_t j = 0; j < row.size(); ++j) {
      const double g_ij = area[i] * row[j];
      const double g_ji = area[j] * column[j];
      difference[i] += (g_ij - g_ji) * (g_ij - g_ji);
      total[i] += g_ij * g_ij;
    }
  });
  const double scale = std::accumulate(total.begin(), total.end(), 0.0);
  if (scale == 0) return 0;
  return std::sqrt(std::accumulate(difference.begin(), difference.end(), 0.0) / scale);
}

SymmetricMatrix symmetrized(const RowMatrix& matrix) {
  const std::span<const double> area = matrix.area();
  std::vector<Index> order(matrix.size());
  std::iota(order.begin(), order.end(), Index(0));
  SymmetricMatrix merged({area.begin(), area.end()}, std::move(order), matrix.precision(),
                         matrix.scratch());
  forBothEstimates(matrix, [&](std::size_t i, auto row, auto column) {
    std::vector<double> factors(row.size() - i, 0.0);
    for (std::size_t j = i; j < row.size(); ++j) {
      if (row[j] == 0 && column[j] == 0) continue;
      const double g = estimateWeight(area[i], area[j]) * (area[i] * row[j]) +
                       estimateWeight(area[j], area[i]) * (area[j] * column[j]);
      if (g > 0) factors[j - i] = g / area[i];  // g is 0 if an area is 0
    }
    merged.setUpperRow(i, factors);
  });
  return merged;
}

}  // namespace radiosity
