// Writes the matrix.
#include <algorithm>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "results/column_writer.h"
#include "results/matrix_blocks.h"

namespace radiosity {

using h5::ColumnWriter;
using h5::Number;

namespace {

/// The most entries that are converted at a time, unless one row has more.
constexpr std::int64_t kEntriesAtOnce = std::int64_t(1) << 18;

std::vector<std::int64_t> rowStarts(const ExchangeMatrix& matrix) {
  std::vector<std::int64_t> indptr(matrix.size() + 1, 0);
  const std::vector<Index> entries = matrix.rowEntries();
  std::copy(entries.begin(), entries.end(), indptr.begin() + 1);
  for (std::size_t i = 0; i < matrix.size(); ++i) indptr[i + 1] += indptr[i];
  return indptr;
}

/// Writes the entries of rows that begin at the entries `starts`.
template <class T>
void writeEntries(h5::OutputGroup& group, const ExchangeMatrix& matrix,
                  std::span<const std::int64_t> starts, Progress& progress) {
  const auto entries = std::size_t(starts.back());
  ColumnWriter<std::int32_t> indices(group, "indices", entries);
  ColumnWriter<T> data(group, "data", entries);
  progress.begin("writing form factors", matrix.size());
  matrix.forPanels([&](const RowPanel& rows) {
    for (std::size_t first = rows.first(); first < rows.last();) {
      progress.check();
      std::size_t last = first + 1;
      while (last < rows.last() && starts[last + 1] - starts[first] <= kEntriesAtOnce) ++last;
      const auto count = std::size_t(starts[last] - starts[first]);
      const std::span<std::int32_t> columns = indices.extend(count);
      const std::span<T> values = data.extend(count);
      parallelFor(last - first, 1, [&](std::size_t k) {
        auto at = std::size_t(starts[first + k] - starts[first]);
        rows.forRow(first + k, [&](Index column, double value) {
          columns[at] = std::int32_t(column);
          values[at++] = T(value);
        });
      });
      progress.advance(last - first);
      first = last;
    }
  });
  progress.check();  // an interruption during the last rows
  indices.flush();
  data.flush();
  progress.end();
}

/// Writes shape, indptr, indices and data.
void writeRows(h5::OutputGroup& group, const ExchangeMatrix& matrix, Progress& progress) {
  const std::int64_t n = std::int64_t(matrix.size());
  const std::int64_t shape[2] = {n, n};
  group.dataset("shape", {Number::i64, 2, 0}, shape, "");
  const std::vector<std::int64_t> indptr = rowStarts(matrix);
  group.dataset("indptr", {Number::i64, indptr.size(), 0}, indptr.data(), "");
  if (matrix.precision() == Precision::single_precision) {
    writeEntries<float>(group, matrix, indptr, progress);
  } else {
    writeEntries<double>(group, matrix, indptr, progress);
  }
}

void countRows(h5::SizeCounter& group, const ExchangeMatrix& matrix) {
  const std::size_t entries = matrix.nonZeros();
  const Number number =
      matrix.precision() == Precision::single_precision ? Number::f32 : Number::f64;
  group.dataset("shape", {Number::i64, 2, 0}, nullptr, "");
  group.dataset("indptr", {Number::i64, matrix.size() + 1, 0}, nullptr, "");
  group.dataset("indices", {Number::i32, entries, 0}, nullptr, "");
  group.dataset("data", {number, entries, 0}, nullptr, "");
}

}  // namespace

void writeMatrix(h5::OutputGroup& group, const ExchangeMatrix& matrix, Progress& progress) {
  group.dataset("area", {Number::f64, matrix.size(), 0}, matrix.area().data(), "m^2");
  if (matrix.isSymmetric()) {
    group.dataset("order", {h5::numberOf<Index>(), matrix.size(), 0}, matrix.order().data(), "");
  }
  const std::vector<double> sums = matrix.rowSums();
  group.dataset("row_sum", {Number::f64, sums.size(), 0}, sums.data(), "");
  writeRows(group, matrix, progress);
}

void countMatrix(h5::SizeCounter& group, const ExchangeMatrix& matrix) {
  const std::size_t n = matrix.size();
  group.dataset("area", {Number::f64, n, 0}, nullptr, "m^2");
  if (matrix.isSymmetric()) group.dataset("order", {h5::numberOf<Index>(), n, 0}, nullptr, "");
  group.dataset("row_sum", {Number::f64, n, 0}, nullptr, "");
  countRows(group, matrix);
}

}  // namespace radiosity
