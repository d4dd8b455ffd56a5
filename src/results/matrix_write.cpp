// Writes the matrix.
#include <algorithm>
#include <vector>

#include "results/column_writer.h"
#include "results/matrix_blocks.h"

namespace radiosity {

using h5::ColumnWriter;
using h5::Number;

namespace {

std::vector<std::int64_t> rowStarts(const ExchangeMatrix& matrix) {
  std::vector<std::int64_t> indptr(matrix.size() + 1, 0);
  const std::vector<Index> entries = matrix.rowEntries();
  std::copy(entries.begin(), entries.end(), indptr.begin() + 1);
  for (std::size_t i = 0; i < matrix.size(); ++i) indptr[i + 1] += indptr[i];
  return indptr;
}

template <class T>
void writeEntries(h5::OutputGroup& group, const ExchangeMatrix& matrix, std::size_t entries,
                  Progress& progress) {
  ColumnWriter<std::int32_t> indices(group, "indices", entries);
  ColumnWriter<T> data(group, "data", entries);
  progress.begin("writing form factors", matrix.size());
  matrix.forPanels([&](const RowPanel& rows) {
    for (std::size_t i = rows.first(); i < rows.last(); ++i) {
      progress.check();
      rows.forRow(i, [&](Index column, double value) {
        indices.push(std::int32_t(column));
        data.push(T(value));
      });
      progress.advance();
    }
  });
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
  const auto entries = std::size_t(indptr.back());
  if (matrix.precision() == Precision::single_precision) {
    writeEntries<float>(group, matrix, entries, progress);
  } else {
    writeEntries<double>(group, matrix, entries, progress);
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
