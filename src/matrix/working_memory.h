// The memory needed beside the matrix for writing and solving.
#pragma once

#include <algorithm>
#include <cstddef>

#include "matrix/triangle_pass.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Bytes of the chunks of indices and values that are being written, HDF5's own included.
inline constexpr std::size_t kFileChunks = std::size_t(16) << 20;

/// The rows of a dense matrix of N rows that a thread lays out at a time, with all their zeros, to
/// gather them from the triangle: 16 MiB if that is between 8 and 64 rows.
inline std::size_t laidOutRows(std::size_t n) {
  constexpr std::size_t kBytes = std::size_t(16) << 20;
  return std::clamp<std::size_t>(kBytes / std::max<std::size_t>(n * sizeof(double), 1), 8, 64);
}

/// The most bytes that writing a symmetric matrix of N rows or solving in three bands takes at
/// once, beside the panels of rows (ExchangeMatrix::panelBytes()).
inline std::size_t matrixWorkingMemory(std::size_t n, std::size_t threads) {
  constexpr std::size_t kBands = 3;
  const std::size_t row = n * sizeof(double);
  const std::size_t all = n * row;
  const std::size_t chunks = std::min(2 * all, kFileChunks);
  const std::size_t starts = 2 * row;           // start and length of the rows in the file
  const std::size_t fields = 8 * kBands * row;  // B, H, E, reflectance, and by position
  const std::size_t laid_out = std::min(threads * laidOutRows(n), n) * row;
  return std::max(laid_out + starts + chunks, TrianglePass::bytes(n, kBands) + fields);
}

}  // namespace radiosity
