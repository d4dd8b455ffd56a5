// The inner loops over rows of the triangle: what they gather and what they hand on.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Bands that a kernel serves at once.
inline constexpr int kMaxBands = 4;

/// Rows that a kernel serves at once: where all of them have values, x and z are loaded once for
/// several rows.
inline constexpr std::size_t kMaxRows = 8;

/// Running sums a row and band: what is gathered from place q goes to sum q modulo kSums, places
/// increasing, and the sums are added up in a fixed order. So every instruction set gives the same
/// bits, whatever it holds in a vector, and so does any number of rows at once.
inline constexpr std::size_t kSums = 8;

/// Kernels work on whole vectors: places from one multiple of kSums to the next, of which a row
/// has some, may all be read (they must hold finite numbers) and written back unchanged. So many
/// values beyond a row's last are read.
inline constexpr std::size_t kOverrun = kSums - 1;

/// Vectors of some bands, one plane of values a band, `..._stride` apart, by place. Walks are
/// fastest where planes are aligned to a cache line.
struct RowOperands {
  const double* x = nullptr;  ///< gathered from
  std::size_t x_stride = 0;
  double* z = nullptr;  ///< handed on to
  std::size_t z_stride = 0;
  int bands = 0;  ///< 1 to kMaxBands
};

/// Consecutive rows as packRuns() makes them, 1 to kMaxRows: offset 0 of row r is at place
/// first + r.
struct RowBlock {
  std::span<const RunRow> rows;
  std::size_t first = 0;
};

struct TriangleKernels {
  const char* target;  ///< instruction set
  /// sums[r * bands + b] = sum over row r of value * x_b[place].
  void (*gather)(const RowBlock& block, const RowOperands& operands, double* sums);
  /// z_b[place] += value * factor[r * bands + b], row after row.
  void (*hand_on)(const RowBlock& block, const RowOperands& operands, const double* factor);
  /// Both in one pass. Several rows at once are faster here than one after the other.
  void (*gather_and_hand_on)(const RowBlock& block, const RowOperands& operands,
                             const double* factor, double* sums);
};

/// For the best instruction set this machine has.
TriangleKernels triangleKernels();

}  // namespace radiosity
