#include "radiosity/exchange_matrix.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/scratch_rows.h"
#include "matrix/matrix_row.h"
#include "matrix/run_row.h"
#include "matrix/shared_rows.h"

namespace radiosity {

namespace {

/// Rows that a thread counts at a time.
constexpr std::size_t kCountedRows = 64;

void checkRow(std::size_t i, std::size_t n, std::span<const Index> columns,
              std::span<const double> values) {
  if (i >= n) throw InputError(fmt::format("exchange matrix: row {} of {}", i, n));
  if (columns.size() != values.size()) {
    throw InputError(fmt::format("exchange matrix, row {}: {} columns but {} values", i,
                                 columns.size(), values.size()));
  }
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k] >= n || (k > 0 && columns[k] <= columns[k - 1])) {
      throw InputError(fmt::format(
          "exchange matrix, row {}: column {} is out of order or not below {}", i, columns[k], n));
    }
    if (!(values[k] > 0) || !std::isfinite(values[k])) {
      throw InputError(fmt::format("exchange matrix, row {}, column {}: {} is not a form factor", i,
                                   columns[k], values[k]));
    }
  }
}

template <class Row>
std::size_t bytesOf(const Row& row) {
  return row.columns.size() * sizeof(Index) + row.floats.size() * sizeof(float) +
         row.doubles.size() * sizeof(double);
}

}  // namespace

ExchangeMatrix::ExchangeMatrix() = default;
ExchangeMatrix::ExchangeMatrix(const ExchangeMatrix&) = default;
ExchangeMatrix::ExchangeMatrix(ExchangeMatrix&&) noexcept = default;
ExchangeMatrix& ExchangeMatrix::operator=(const ExchangeMatrix& other) {
  return *this = ExchangeMatrix(other);
}
ExchangeMatrix& ExchangeMatrix::operator=(ExchangeMatrix&& other) noexcept {
  // The destructor frees the rows before the scratch memory that they are in.
  if (this == &other) return *this;
  std::destroy_at(this);
  return *std::construct_at(this, std::move(other));
}
ExchangeMatrix::~ExchangeMatrix() = default;

ExchangeMatrix::ExchangeMatrix(std::vector<double> area, Precision precision,
                               std::shared_ptr<ScratchMemory> scratch)
    : area_(std::move(area)), precision_(precision) {
  scratch_.memory = std::move(scratch);
  rows_.reserve(area_.size());
  std::pmr::memory_resource* const memory = rowMemory(scratch_.memory.get());
  for (std::size_t i = 0; i < area_.size(); ++i) rows_.emplace_back(memory);
  for (std::size_t i = 0; i < area_.size(); ++i) {
    if (!(area_[i] >= 0) || !std::isfinite(area_[i])) {
      throw InputError(fmt::format("exchange matrix: {} is not the area of patch {}", area_[i], i));
    }
  }
}

ExchangeMatrix ExchangeMatrix::shared(std::shared_ptr<const SharedRows> rows) {
  const ExchangeMatrix& own = rows->own();
  ExchangeMatrix matrix;
  matrix.area_ = own.area_;
  matrix.precision_ = own.precision_;
  matrix.symmetric_ = own.symmetric_;
  matrix.order_ = own.order_;
  matrix.position_ = own.position_;
  if (matrix.symmetric_) matrix.diagonal_.assign(matrix.size(), 0.0);  // must not be read
  matrix.shared_ = std::move(rows);
  return matrix;
}

void ExchangeMatrix::requireRows(const char* what) const {
  if (!shared_) return;
  throw RunError(
      fmt::format("{} needs all rows of the form factors in one process; start that "
                  "without mpirun, from the results file",
                  what));
}

void ExchangeMatrix::setRow(std::size_t i, std::span<const Index> columns,
                            std::span<const double> values) {
  requireRows("setting a row");
  if (symmetric_) throw InputError("exchange matrix: a symmetric one is set by upper rows");
  checkRow(i, size(), columns, values);
  const std::size_t value_bytes = valueBytes(precision_);
  Row row(rowMemory(scratch_.memory.get()));
  row.dense = size() * value_bytes < columns.size() * (value_bytes + sizeof(Index));
  const auto fill = [&](auto& stored) {
    using Value = typename std::remove_reference_t<decltype(stored)>::value_type;
    stored.resize(row.dense ? size() : columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      stored[row.dense ? columns[k] : k] = Value(values[k]);
    }
  };
  if (!row.dense) row.columns.assign(columns.begin(), columns.end());
  if (precision_ == Precision::single_precision) {
    fill(row.floats);
  } else {
    fill(row.doubles);
  }
  rows_[i] = std::move(row);
}

RowView ExchangeMatrix::viewOf(std::size_t i) const {
  requireRows("what walks along stored rows");
  const Row& row = rows_[i];
  touchRows(scratch_.memory.get(), bytesOf(row));
  return {row.columns, row.floats, row.doubles, row.dense};
}

double ExchangeMatrix::at(std::size_t i, std::size_t j) const {
  if (shared_) {
    double found = 0;
    forRow(i, j, j + 1, [&](Index, double value) { found = value; });
    return found;
  }
  if (!symmetric_) {
    double found = 0;
    viewOf(i).forEntries(j, j + 1, [&](Index, double value) { found = value; });
    return found;
  }
  if (position_[i] <= position_[j]) return storedUpper(position_[i], position_[j]);
  const double mirrored = storedUpper(position_[j], position_[i]);
  return mirrored == 0 ? 0 : mirrored * area_[j] / area_[i];
}

std::vector<Index> ExchangeMatrix::rowEntries() const {
  if (shared_) return shared_->rowEntries();
  std::vector<Index> entries(size(), 0);
  parallelFor(rows_.size(), kCountedRows, [&](std::size_t i) {
    viewOf(i).forEntries(0, size(), [&](Index, double) { ++entries[i]; });
  });
  tbb::enumerable_thread_specific<std::vector<Index>> counts(std::vector<Index>(upper_.size(), 0));
  parallelFor(upper_.size(), kCountedRows, [&](std::size_t k) {
    std::vector<Index>& count = counts.local();
    Index own = diagonal_[k] != 0 ? 1 : 0;
    forRuns(upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t length) {
      const Index* later = &order_[k] + 1 + offset;
      for (std::size_t m = 0; m < length; ++m) {
        const Index stored = values[m] != 0 ? 1 : 0;
        own += stored;
        count[later[m]] += stored;
      }
    });
    count[order_[k]] += own;
  });
  for (const std::vector<Index>& count : counts) {
    for (std::size_t i = 0; i < count.size(); ++i) entries[i] += count[i];
  }
  return entries;
}

std::size_t ExchangeMatrix::nonZeros() const {
  const std::vector<Index> entries = rowEntries();
  return std::accumulate(entries.begin(), entries.end(), std::size_t(0));
}

std::size_t ExchangeMatrix::bytes() const {
  if (shared_) return shared_->sizes().bytes;
  std::size_t total = 0;
  for (const Row& row : rows_) total += bytesOf(row);
  for (const RunRow& row : upper_) total += bytesOf(row);
  return total + diagonal_.size() * sizeof(double);
}

std::size_t ExchangeMatrix::denseRows() const {
  if (shared_) return shared_->sizes().dense_rows;
  return std::size_t(
      std::count_if(rows_.begin(), rows_.end(), [](const Row& r) { return r.dense; }));
}

std::vector<double> ExchangeMatrix::rowSums() const {
  if (shared_) return shared_->rowSums();
  const std::vector<double> ones(size(), 1.0);
  std::vector<double> sums(size());
  product(ones, 1, sums);
  return sums;
}

}  // namespace radiosity
