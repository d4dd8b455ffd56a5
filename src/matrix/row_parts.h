// Rows of F put together from the entries that several processes hold of them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Rows first to last - 1.
struct RowRange {
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t size() const { return last - first; }
};

/// What one process holds of some rows, row by row.
struct RowsPart {
  std::vector<Index> counts;  ///< entries of each row
  std::vector<Index> columns;
  std::vector<double> values;
};

RowsPart partOf(const ExchangeMatrix& own, RowRange rows);

/// Rows of a part, counted from its first one.
RowsPart rowsOf(const RowsPart& part, RowRange rows);

/// A part as bytes, to send to another process, and back.
std::vector<std::byte> bytesOf(const RowsPart& part);
RowsPart partFrom(std::span<const std::byte> bytes);

/// Puts the entries that the parts hold of each row one after the other, sorted. `n`: columns of
/// the matrix.
void mergeParts(std::span<const RowsPart> parts, std::size_t n, CompressedRows& rows);

}  // namespace radiosity
