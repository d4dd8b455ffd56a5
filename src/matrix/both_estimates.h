// Both estimates of every pair: a walk along the rows and columns of a matrix, side by side.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// The number of columns that forBothEstimates() gathers at once.
inline constexpr std::size_t kColumnsAtOnce = 128;

/// The bytes that it takes for N rows.
inline std::size_t bothEstimatesBytes(std::size_t n, std::size_t threads) {
  return (std::min(kColumnsAtOnce, n) + threads) * n * sizeof(double);
}

/// Calls visit(i, row, column) for every i, row[j] = F_ij and column[j] = F_ji, both N values with
/// zeros where nothing is stored. Calls run in parallel. It gathers columns a block at a time, so
/// that memory beyond the matrix is kColumnsAtOnce * N values instead of a transposed copy. For
/// matrices that are not symmetric.
template <class Visit>
void forBothEstimates(const ExchangeMatrix& matrix, const Visit& visit) {
  constexpr std::size_t kBlock = kColumnsAtOnce;
  const std::size_t n = matrix.size();
  std::vector<double> columns(std::min(kBlock, n) * n);
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = std::min(kBlock, n - begin);
    std::fill(columns.begin(), columns.end(), 0.0);
    matrix.columns(begin, begin + count, std::span(columns).first(count * n));
    const RowPanel rows(matrix, begin, begin + count);
    parallelFor(count, 1, [&](std::size_t k) {
      std::vector<double> row(n, 0.0);
      rows.forRow(begin + k, [&](Index j, double value) { row[j] = value; });
      visit(begin + k, std::span<const double>(row),
            std::span<const double>(columns).subspan(k * n, n));
    });
  }
}

}  // namespace radiosity
