// The inner loops over rows of the triangle, which gather sums and hand values on to later rows.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/symmetric_matrix.h"

namespace radiosity {

/// The most bands that a kernel serves at once.
inline constexpr int kMaxBands = 4;

/// The most rows that a kernel serves at once. Where all of them have values, x and z are loaded
/// once for several rows.
inline constexpr std::size_t kMaxRows = 8;

/// The running sums for each row and band. The product at place q is added to sum q modulo kSums,
/// in the order of places and rounded once (a fused multiply-add), and the sums are added up in a
/// fixed order. So every vector length and any number of rows at once give the same bits.
inline constexpr std::size_t kSums = 8;

/// Kernels read up to this many values beyond a row's last. They work on whole vectors: if a row
/// has some of the places from one multiple of kSums to the next, all of them may be read (they
/// must hold finite numbers) and written back unchanged.
inline constexpr std::size_t kOverrun = kSums - 1;

/// Vectors of some bands, by place: one plane of values a band, `..._stride` apart. Walks are
/// fastest if planes are aligned to a cache line.
struct RowOperands {
  const double* x = nullptr;  ///< gathered from
  std::size_t x_stride = 0;
  double* z = nullptr;  ///< scattered to
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
  /// z_b[place] += value * factor[r * bands + b], rounded once, row after row.
  void (*scatter)(const RowBlock& block, const RowOperands& operands, const double* factor);
  /// Does both in one pass. Here several rows at once are faster than one after the other.
  void (*gather_and_scatter)(const RowBlock& block, const RowOperands& operands,
                             const double* factor, double* sums);
};

/// The kernels for the best instruction set of this machine.
TriangleKernels triangleKernels();

}  // namespace radiosity
