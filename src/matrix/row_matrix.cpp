#include "radiosity/row_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory_resource>
#include <utility>

#include "base/parallel.h"
#include "base/scratch_rows.h"
#include "matrix/bands_at_once.h"
#include "matrix/expected_bytes.h"

namespace radiosity {

/// The values are in `floats` or in `doubles`, by precision.
struct RowMatrix::Row {
  explicit Row(std::pmr::memory_resource* memory)
      : columns(memory), floats(memory), doubles(memory) {}
  std::size_t bytes() const {
    return columns.size() * sizeof(Index) + floats.size() * sizeof(float) +
           doubles.size() * sizeof(double);
  }

  std::pmr::vector<Index> columns;  ///< empty for a dense row
  std::pmr::vector<float> floats;
  std::pmr::vector<double> doubles;
  bool dense = false;
};

namespace {

/// Rows that a thread counts at a time.
constexpr std::size_t kCountedRows = 64;

/// The rows that a thread takes at a time: enough work to hide the scheduling of sparse rows.
constexpr std::size_t kProductGrain = 16;

/// Values of one stored row. `columns` is null for a dense row.
template <class Value>
struct StoredValues {
  const Value* values;
  const Index* columns;
  std::size_t count;
};

/// out[b] = sum over the row of value * x[column * stride + b], for `kBands` bands.
///
/// Four running sums a band, picked by column modulo 4, keep the additions from waiting for each
/// other. The order of additions depends on the columns alone and adding a stored 0 changes
/// nothing, so dense and sparse storage give the same bits.
template <int kBands, class Value>
void dot(const StoredValues<Value>& row, const double* x, std::size_t stride, double* out) {
  constexpr std::size_t kLanes = 4;
  double sum[kLanes][kBands] = {};
  const auto add = [&](std::size_t lane, std::size_t column, double value) {
    for (int b = 0; b < kBands; ++b) sum[lane][b] += value * x[column * stride + std::size_t(b)];
  };
  std::size_t k = 0;
  if (row.columns == nullptr) {
    for (; k + kLanes <= row.count; k += kLanes) {
      for (std::size_t lane = 0; lane < kLanes; ++lane) add(lane, k + lane, row.values[k + lane]);
    }
    for (; k < row.count; ++k) add(k % kLanes, k, row.values[k]);
  } else {
    for (; k < row.count; ++k) add(row.columns[k] % kLanes, row.columns[k], row.values[k]);
  }
  for (int b = 0; b < kBands; ++b) out[b] = (sum[0][b] + sum[1][b]) + (sum[2][b] + sum[3][b]);
}

template <class Value>
void dotAllBands(const StoredValues<Value>& row, const double* x, int bands, double* out) {
  forBandsAtOnce(bands,
                 [&]<int kBands>(int b) { dot<kBands>(row, x + b, std::size_t(bands), out + b); });
}

/// out[b] = sum over the row of F_ij x[j * bands + b].
void rowProduct(const RowView& row, const double* x, int bands, double* out) {
  const Index* columns = row.dense ? nullptr : row.columns.data();
  if (row.doubles.empty()) {
    dotAllBands(StoredValues<float>{row.floats.data(), columns, row.floats.size()}, x, bands, out);
  } else {
    dotAllBands(StoredValues<double>{row.doubles.data(), columns, row.doubles.size()}, x, bands,
                out);
  }
}

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

}  // namespace

RowMatrix::RowMatrix(std::vector<double> area, Precision precision,
                     std::shared_ptr<ScratchMemory> scratch)
    : ExchangeMatrix(std::move(area), false, {}, precision), scratch_(std::move(scratch)) {
  rows_.reserve(size());
  for (std::size_t i = 0; i < size(); ++i) rows_.emplace_back(rowMemory(scratch_.get()));
}
RowMatrix::RowMatrix(RowMatrix&&) noexcept = default;
RowMatrix::~RowMatrix() = default;

void RowMatrix::setRow(std::size_t i, std::span<const Index> columns,
                       std::span<const double> values) {
  checkRow(i, size(), columns, values);
  const std::size_t value_bytes = valueBytes(precision());
  Row row(rowMemory(scratch_.get()));
  row.dense = size() * value_bytes < columns.size() * (value_bytes + sizeof(Index));
  const auto fill = [&](auto& stored) {
    using Value = typename std::remove_reference_t<decltype(stored)>::value_type;
    stored.resize(row.dense ? size() : columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      stored[row.dense ? columns[k] : k] = Value(values[k]);
    }
  };
  if (!row.dense) row.columns.assign(columns.begin(), columns.end());
  if (precision() == Precision::single_precision) {
    fill(row.floats);
  } else {
    fill(row.doubles);
  }
  rows_[i] = std::move(row);
}

RowView RowMatrix::viewOf(std::size_t i) const {
  const Row& row = rows_[i];
  touchRows(scratch_.get(), row.bytes());
  return {row.columns, row.floats, row.doubles, row.dense};
}

std::vector<Index> RowMatrix::rowEntries() const {
  std::vector<Index> entries(size(), 0);
  parallelFor(size(), kCountedRows, [&](std::size_t i) {
    viewOf(i).forEntries(0, size(), [&](Index, double) { ++entries[i]; });
  });
  return entries;
}

std::size_t RowMatrix::bytes() const {
  std::size_t total = 0;
  for (const Row& row : rows_) total += row.bytes();
  return total;
}

std::size_t RowMatrix::denseRows() const {
  return std::size_t(std::ranges::count(rows_, true, &Row::dense));
}

void RowMatrix::multiply(std::span<const double> x, int bands, std::span<double> y,
                         std::span<const std::uint8_t> wanted) const {
  parallelFor(size(), kProductGrain, [&](std::size_t i) {
    if (!wanted.empty() && wanted[i] == 0) return;
    rowProduct(viewOf(i), x.data(), bands, &y[i * std::size_t(bands)]);
  });
}

void RowMatrix::sweep(std::span<double> x, int bands, const Update& update,
                      std::span<const std::uint8_t> wanted) const {
  std::vector<double> gathered(static_cast<std::size_t>(bands));
  for (std::size_t i = 0; i < size(); ++i) {
    if (!wanted.empty() && wanted[i] == 0) continue;
    rowProduct(viewOf(i), x.data(), bands, gathered.data());
    update(i, gathered.data());
  }
}

}  // namespace radiosity
