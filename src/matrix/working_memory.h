// The memory that writing, reading and solving take beside the matrix.
#pragma once

#include <algorithm>
#include <cstddef>

#include "matrix/triangle_pass.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// The most bytes that writing a symmetric matrix of N rows, reading it back or solving in three
/// bands takes at once, HDF5's own buffers left out.
inline std::size_t matrixWorkingMemory(std::size_t n, std::size_t threads) {
  constexpr std::size_t kBands = 3;
  constexpr std::size_t kFileBlocks = std::size_t(24) << 20;  // of indices and values, in chunks
  const std::size_t row = n * sizeof(double);
  const std::size_t all = n * row;
  const std::size_t panel = std::min(all, std::max(ExchangeMatrix::kPanelBytes, row));
  const std::size_t blocks = std::min(2 * all, kFileBlocks);
  const std::size_t starts = 2 * row;           // where rows start in the file, how long they are
  const std::size_t fields = 8 * kBands * row;  // B, H, E, reflectance, and by position
  return std::max(panel + threads * row + starts + blocks, TrianglePass::bytes(n, kBands) + fields);
}

}  // namespace radiosity
