// The inner loops over a row of the triangle: what it gathers and what it hands on.
#pragma once

#include <cstddef>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Bands a walk along a row serves at once; more bands take another walk, from the cache.
inline constexpr int kMaxBands = 4;

/// Running sums a band: the value at place m of a run goes to sum m modulo kSums, and they are
/// added up in a fixed order. So every instruction set gives the same bits, whatever it holds in a
/// vector.
inline constexpr std::size_t kSums = 8;

/// Kernels work on whole vectors: that many places beyond a row's last may be read (they must hold
/// finite numbers) and written back unchanged.
inline constexpr std::size_t kOverrun = kSums - 1;

/// Vectors of some bands, one plane of values a band, `..._stride` apart.
struct RowOperands {
  const double* x = nullptr;  ///< gathered from, at the row's first offset
  std::size_t x_stride = 0;
  double* z = nullptr;  ///< handed on to, likewise
  std::size_t z_stride = 0;
  int bands = 0;  ///< 1 to kMaxBands
};

/// One row at a time; rows as packRuns() makes them.
struct TriangleKernels {
  const char* target;  ///< instruction set
  /// sums[b] = sum over the row of value * x_b[offset].
  void (*gather)(const RunRow& row, const RowOperands& operands, double* sums);
  /// z_b[offset] += value * factor[b].
  void (*hand_on)(const RunRow& row, const RowOperands& operands, const double* factor);
  /// Both in one pass.
  void (*gather_and_hand_on)(const RunRow& row, const RowOperands& operands, const double* factor,
                             double* sums);
};

/// For the best instruction set this machine has.
TriangleKernels triangleKernels();

}  // namespace radiosity
