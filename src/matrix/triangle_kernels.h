// The inner loops over a row of the triangle: what it gathers and what it hands on.
#pragma once

#include <cstddef>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Bands a walk along a row serves at once; more bands take another walk, from the cache.
inline constexpr int kMaxBands = 4;

/// Vectors of some bands, one plane of values a band, `..._stride` apart.
struct RowOperands {
  const double* x = nullptr;  ///< gathered from, at the row's first offset
  std::size_t x_stride = 0;
  double* z = nullptr;  ///< handed on to, likewise
  std::size_t z_stride = 0;
  int bands = 0;  ///< 1 to kMaxBands
};

/// sums[b] = sum over the row of value * x_b[offset].
void gatherRow(const RunRow& row, const RowOperands& operands, double* sums);

/// z_b[offset] += value * factor[b].
void handOnRow(const RunRow& row, const RowOperands& operands, const double* factor);

/// Both in one pass.
void gatherAndHandOnRow(const RunRow& row, const RowOperands& operands, const double* factor,
                        double* sums);

}  // namespace radiosity
