#include "results/matrix_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <vector>

#include "base/parallel.h"

namespace radiosity {

using h5::Number;
using h5::Shape;

namespace {

constexpr std::size_t kRowGrain = 64;

/// Fills a dataset of one dimension in order, a chunk at a time: HDF5 makes the checksum of each
/// chunk once and reads none back.
template <class T>
class ColumnWriter {
 public:
  ColumnWriter(h5::OutputGroup& group, const char* name, std::size_t count)
      : group_(&group), name_(name) {
    const Shape shape{h5::numberOf<T>(), count, 0};
    dataset_ = group.create(name, shape, "");
    chunk_ = h5::chunkRows(shape);
    buffer_.reserve(std::min(chunk_, count));
  }
  void push(T value) {
    buffer_.push_back(value);
    if (buffer_.size() == chunk_) flush();
  }
  void flush() {
    if (buffer_.empty()) return;
    group_->writeRows(name_, dataset_, h5::numberOf<T>(), written_, buffer_.size(), buffer_.data());
    written_ += buffer_.size();
    buffer_.clear();
  }

 private:
  h5::OutputGroup* group_;
  const char* name_;
  h5::Handle dataset_;
  std::size_t chunk_ = 0;
  std::size_t written_ = 0;
  std::vector<T> buffer_;
};

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

/// Row starts, checked: from 0 upward to the number of entries, no row longer than the matrix.
std::vector<std::int64_t> readRowStarts(const h5::InputGroup& group, std::size_t n,
                                        std::size_t entries) {
  std::size_t rows = 0;
  const h5::Handle dataset = group.open("indptr", Number::i64, 0, rows);
  if (rows != n + 1) group.fail("indptr", fmt::format("has {} values, not {}", rows, n + 1));
  std::vector<std::int64_t> indptr(rows);
  group.readAll("indptr", dataset, Number::i64, indptr.data());
  bool good = indptr.front() == 0 && indptr.back() == std::int64_t(entries);
  for (std::size_t i = 0; i < n && good; ++i) {
    good = indptr[i + 1] >= indptr[i] && indptr[i + 1] - indptr[i] <= std::int64_t(n);
  }
  if (!good) group.fail("indptr", "does not divide the entries into rows");
  return indptr;
}

/// Moves the rows [first, last) of the file into the matrix.
template <class T>
class BlockReader {
 public:
  BlockReader(const h5::InputGroup& group, const std::vector<std::int64_t>& indptr,
              ExchangeMatrix& matrix)
      : group_(&group), indptr_(&indptr), matrix_(&matrix) {
    std::size_t rows = 0;
    indices_ = group.open("indices", Number::i32, 0, rows);
    data_ = group.open("data", h5::numberOf<T>(), 0, rows);
    position_.resize(matrix.order().size());
    for (std::size_t k = 0; k < position_.size(); ++k) position_[matrix.order()[k]] = Index(k);
  }
  void read(std::size_t first, std::size_t last) {
    const std::size_t begin = std::size_t((*indptr_)[first]);
    const std::size_t count = std::size_t((*indptr_)[last]) - begin;
    columns_.resize(count);
    values_.resize(count);
    if (count > 0) {
      group_->readRows("indices", indices_, Number::i32, begin, count, columns_.data());
      group_->readRows("data", data_, h5::numberOf<T>(), begin, count, values_.data());
    }
    parallelFor(last - first, kRowGrain, [&](std::size_t k) { setRow(first + k, begin); });
  }
  /// After the last row.
  void finish() const {
    if (surplus_ != 0) group_->fail("indices", "is not that of a symmetric matrix");
  }

 private:
  /// The row's entries, checked.
  std::span<const std::int32_t> columnsOf(std::size_t i, std::size_t from, std::size_t to) const {
    const std::span columns = std::span(columns_).subspan(from, to - from);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      // A negative column is a large one once it is unsigned.
      if (Index(columns[k]) >= matrix_->size() || (k > 0 && columns[k] <= columns[k - 1])) {
        group_->fail("indices", fmt::format("has a row ({}) whose columns do not increase", i));
      }
      const T value = values_[from + k];
      if (!(value > 0) || !std::isfinite(value)) {
        group_->fail("data", fmt::format("has a row ({}) with the form factor {}", i, value));
      }
    }
    return columns;
  }

  void setRow(std::size_t i, std::size_t block_begin) {
    const std::size_t from = std::size_t((*indptr_)[i]) - block_begin;
    const std::size_t to = std::size_t((*indptr_)[i + 1]) - block_begin;
    const std::span<const std::int32_t> columns = columnsOf(i, from, to);
    const std::span<const T> values = std::span<const T>(values_).subspan(from, to - from);
    if (matrix_->isSymmetric()) {
      setUpperRow(i, columns, values);
    } else {
      matrix_->setRow(i, std::vector<Index>(columns.begin(), columns.end()),
                      std::vector<double>(values.begin(), values.end()));
    }
  }

  /// Of a symmetric matrix one of each pair is kept: that of the patch which comes first.
  void setUpperRow(std::size_t i, std::span<const std::int32_t> columns,
                   std::span<const T> values) {
    const Index k = position_[i];
    std::vector<double> factors(matrix_->size() - k, 0.0);
    std::ptrdiff_t surplus = 0;
    for (std::size_t m = 0; m < columns.size(); ++m) {
      const Index later = position_[std::size_t(columns[m])];
      if (later >= k) factors[later - k] = values[m];
      if (later != k) surplus += later > k ? 1 : -1;
    }
    matrix_->setUpperRow(k, factors);
    surplus_.fetch_add(surplus, std::memory_order_relaxed);
  }

  const h5::InputGroup* group_;
  const std::vector<std::int64_t>* indptr_;
  ExchangeMatrix* matrix_;
  h5::Handle indices_;
  h5::Handle data_;
  std::vector<std::int32_t> columns_;
  std::vector<T> values_;
  std::vector<Index> position_;              // by patch, of a symmetric matrix
  std::atomic<std::ptrdiff_t> surplus_ = 0;  // entries to later patches minus those to earlier ones
};

template <class T>
void readEntries(const h5::InputGroup& group, const std::vector<std::int64_t>& indptr,
                 ExchangeMatrix& matrix) {
  // About four chunks: wide enough for all threads, small beside any matrix worth storing.
  const auto block = std::int64_t(4 * h5::kChunkBytes / sizeof(std::int32_t));
  BlockReader<T> reader(group, indptr, matrix);
  const std::size_t n = matrix.size();
  for (std::size_t first = 0; first < n;) {
    std::size_t last = first + 1;
    while (last < n && indptr[last + 1] - indptr[first] <= block) ++last;
    reader.read(first, last);
    first = last;
  }
  reader.finish();
}

/// The patches in the order a symmetric matrix stores them: each once.
std::vector<Index> readOrder(const h5::InputGroup& group, std::size_t n) {
  std::size_t rows = 0;
  const h5::Handle dataset = group.open("order", h5::numberOf<Index>(), 0, rows);
  if (rows != n) group.fail("order", fmt::format("has {} values, not {}", rows, n));
  std::vector<Index> order(n);
  if (n > 0) group.readAll("order", dataset, h5::numberOf<Index>(), order.data());
  std::vector<bool> named(n, false);
  for (const Index patch : order) {
    if (patch >= n || named[patch]) group.fail("order", "does not name every patch once");
    named[patch] = true;
  }
  return order;
}

Number numberOfValues(Precision precision) {
  return precision == Precision::single ? Number::f32 : Number::f64;
}

}  // namespace

void writeMatrix(h5::OutputGroup& group, const ExchangeMatrix& matrix, Progress& progress) {
  const std::int64_t n = std::int64_t(matrix.size());
  const std::int64_t shape[2] = {n, n};
  group.dataset("shape", {Number::i64, 2, 0}, shape, "");
  group.dataset("area", {Number::f64, matrix.size(), 0}, matrix.area().data(), "m^2");
  if (matrix.isSymmetric()) {
    group.dataset("order", {h5::numberOf<Index>(), matrix.size(), 0}, matrix.order().data(), "");
  }
  const std::vector<std::int64_t> indptr = rowStarts(matrix);
  group.dataset("indptr", {Number::i64, indptr.size(), 0}, indptr.data(), "");
  const std::vector<double> sums = matrix.rowSums();
  group.dataset("row_sum", {Number::f64, sums.size(), 0}, sums.data(), "");
  const auto entries = std::size_t(indptr.back());
  if (matrix.precision() == Precision::single) {
    writeEntries<float>(group, matrix, entries, progress);
  } else {
    writeEntries<double>(group, matrix, entries, progress);
  }
}

void countMatrix(h5::SizeCounter& group, const ExchangeMatrix& matrix) {
  const std::size_t n = matrix.size();
  const std::size_t entries = matrix.nonZeros();
  group.dataset("shape", {Number::i64, 2, 0}, nullptr, "");
  group.dataset("area", {Number::f64, n, 0}, nullptr, "m^2");
  if (matrix.isSymmetric()) group.dataset("order", {h5::numberOf<Index>(), n, 0}, nullptr, "");
  group.dataset("indptr", {Number::i64, n + 1, 0}, nullptr, "");
  group.dataset("row_sum", {Number::f64, n, 0}, nullptr, "");
  group.dataset("indices", {Number::i32, entries, 0}, nullptr, "");
  group.dataset("data", {numberOfValues(matrix.precision()), entries, 0}, nullptr, "");
}

ExchangeMatrix readMatrix(const h5::InputGroup& group) {
  const std::optional<Number> number = group.numberOfDataset("data");
  if (number != Number::f32 && number != Number::f64) group.fail("data", "is not f32 or f64");
  std::size_t n = 0;
  const h5::Handle area_set = group.open("area", Number::f64, 0, n);
  std::vector<double> area(n);
  if (n > 0) group.readAll("area", area_set, Number::f64, area.data());
  for (const double a : area) {
    if (!(a >= 0) || !std::isfinite(a)) group.fail("area", fmt::format("holds the area {}", a));
  }
  std::size_t shape_rows = 0;
  std::int64_t shape[2] = {-1, -1};
  const h5::Handle shape_set = group.open("shape", Number::i64, 0, shape_rows);
  if (shape_rows == 2) group.readAll("shape", shape_set, Number::i64, shape);
  if (shape[0] != std::int64_t(n) || shape[1] != std::int64_t(n)) {
    group.fail("shape", fmt::format("is not {0} x {0}, as area says", n));
  }
  std::size_t entries = 0;
  std::size_t index_count = 0;
  group.open("data", *number, 0, entries);
  group.open("indices", Number::i32, 0, index_count);
  if (index_count != entries) {
    group.fail("indices", fmt::format("has {} values, data has {}", index_count, entries));
  }
  const std::vector<std::int64_t> indptr = readRowStarts(group, n, entries);
  const Precision precision = *number == Number::f32 ? Precision::single : Precision::real;
  ExchangeMatrix matrix = group.has("order")
                              ? ExchangeMatrix::symmetric(area, readOrder(group, n), precision)
                              : ExchangeMatrix(area, precision);
  if (*number == Number::f32) {
    readEntries<float>(group, indptr, matrix);
  } else {
    readEntries<double>(group, indptr, matrix);
  }
  return matrix;
}

}  // namespace radiosity
