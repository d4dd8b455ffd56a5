// The norm of F in which its errors are measured.
#include <numeric>
#include <vector>

#include "base/parallel.h"
#include "matrix/run_row.h"
#include "radiosity/matrix_functions.h"

namespace radiosity {

namespace {

constexpr std::size_t kSquaresGrain = 16;

/// sum_m values[m]^2 (1 + area * inverse[m]), in independent running sums.
template <class Value>
double sumOfSquares(const Value* values, double area, const double* inverse, std::size_t count) {
  constexpr std::size_t kLanes = 8;
  double lanes[kLanes] = {};
  const auto add = [&](std::size_t lane, std::size_t m) {
    const double value = values[m];
    lanes[lane] += value * value * (1 + area * inverse[m]);
  };
  std::size_t m = 0;
  for (; m + kLanes <= count; m += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane, m + lane);
  }
  for (; m < count; ++m) add(m % kLanes, m);
  return std::accumulate(lanes, lanes + kLanes, 0.0);
}

double ofRows(const ExchangeMatrix& matrix) {
  std::vector<double> rows(matrix.size(), 0.0);
  matrix.forPanels([&](const RowPanel& panel) {
    parallelFor(panel.last() - panel.first(), kSquaresGrain, [&](std::size_t k) {
      const std::size_t i = panel.first() + k;
      panel.forRow(i, [&](Index, double value) { rows[i] += value * value; });
      rows[i] *= matrix.area()[i];
    });
  });
  return std::accumulate(rows.begin(), rows.end(), 0.0);
}

// Both ends of a pair give A_k F_kq^2 + A_q F_qk^2 = A_k F_kq^2 (1 + A_k / A_q).
double ofTriangle(const SymmetricMatrix& matrix) {
  const std::size_t n = matrix.size();
  std::vector<double> area(n);
  std::vector<double> inverse(n);
  for (std::size_t k = 0; k < n; ++k) {
    area[k] = matrix.area()[matrix.order()[k]];
    inverse[k] = area[k] > 0 ? 1 / area[k] : 0.0;
  }
  std::vector<double> rows(n, 0.0);
  parallelFor(n, kSquaresGrain, [&](std::size_t k) {
    const double diagonal = matrix.diagonal(k);
    rows[k] = diagonal * diagonal;
    forRuns(matrix.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      rows[k] += sumOfSquares(values, area[k], &inverse[k + 1 + offset], count);
    });
    rows[k] *= area[k];
  });
  return std::accumulate(rows.begin(), rows.end(), 0.0);
}

}  // namespace

double weightedSquares(const ExchangeMatrix& matrix) {
  const auto* triangle = dynamic_cast<const SymmetricMatrix*>(&matrix);
  return triangle != nullptr ? ofTriangle(*triangle) : ofRows(matrix);
}

}  // namespace radiosity
