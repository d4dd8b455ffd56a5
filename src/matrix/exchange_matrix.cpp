#include "radiosity/exchange_matrix.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/parallel.h"

namespace radiosity {

namespace {

/// Rows a thread takes at a time: enough work to hide the scheduling of sparse rows.
constexpr std::size_t kRowGrain = 16;

/// Bands summed in one walk along a row; more bands take another walk, from the cache.
constexpr int kMaxBands = 4;

std::size_t valueBytes(Precision precision) {
  return precision == Precision::single ? sizeof(float) : sizeof(double);
}

/// Values of one stored row. `columns` is null for a dense row.
template <class Value>
struct RowView {
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
void dot(const RowView<Value>& row, const double* x, std::size_t stride, double* out) {
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
void dotAllBands(const RowView<Value>& row, const double* x, int bands, double* out) {
  const auto stride = std::size_t(bands);
  for (int b = 0; b < bands; b += kMaxBands) {
    switch (std::min(bands - b, kMaxBands)) {
      case 1:
        dot<1>(row, x + b, stride, out + b);
        break;
      case 2:
        dot<2>(row, x + b, stride, out + b);
        break;
      case 3:
        dot<3>(row, x + b, stride, out + b);
        break;
      default:
        dot<4>(row, x + b, stride, out + b);
        break;
    }
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

ExchangeMatrix::ExchangeMatrix(std::vector<double> area, Precision precision)
    : area_(std::move(area)), precision_(precision), rows_(area_.size()) {
  for (std::size_t i = 0; i < area_.size(); ++i) {
    if (!(area_[i] >= 0) || !std::isfinite(area_[i])) {
      throw InputError(fmt::format("exchange matrix: {} is not the area of patch {}", area_[i], i));
    }
  }
}

void ExchangeMatrix::setRow(std::size_t i, std::span<const Index> columns,
                            std::span<const double> values) {
  checkRow(i, size(), columns, values);
  const std::size_t value_bytes = valueBytes(precision_);
  Row row;
  row.dense = size() * value_bytes < columns.size() * (value_bytes + sizeof(Index));
  const auto fill = [&](auto& stored) {
    using Value = typename std::remove_reference_t<decltype(stored)>::value_type;
    stored.resize(row.dense ? size() : columns.size());
    for (std::size_t k = 0; k < columns.size(); ++k) {
      stored[row.dense ? columns[k] : k] = Value(values[k]);
    }
  };
  if (!row.dense) row.columns.assign(columns.begin(), columns.end());
  if (precision_ == Precision::single) {
    fill(row.single);
  } else {
    fill(row.real);
  }
  rows_[i] = std::move(row);
}

double ExchangeMatrix::at(std::size_t i, std::size_t j) const {
  double found = 0;
  forRow(i, j, j + 1, [&](Index, double value) { found = value; });
  return found;
}

void ExchangeMatrix::rowProduct(std::size_t i, std::span<const double> x, int bands,
                                double* out) const {
  const Row& row = rows_[i];
  const Index* columns = row.dense ? nullptr : row.columns.data();
  if (precision_ == Precision::single) {
    dotAllBands(RowView<float>{row.single.data(), columns, row.single.size()}, x.data(), bands,
                out);
  } else {
    dotAllBands(RowView<double>{row.real.data(), columns, row.real.size()}, x.data(), bands, out);
  }
}

void ExchangeMatrix::product(std::span<const double> x, int bands, std::span<double> y) const {
  parallelFor(size(), kRowGrain,
              [&](std::size_t i) { rowProduct(i, x, bands, &y[i * std::size_t(bands)]); });
}

std::size_t ExchangeMatrix::nonZeros() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < size(); ++i) forRow(i, [&](Index, double) { ++count; });
  return count;
}

std::size_t ExchangeMatrix::bytes() const {
  std::size_t total = 0;
  for (const Row& row : rows_) {
    total += row.columns.size() * sizeof(Index) + row.single.size() * sizeof(float) +
             row.real.size() * sizeof(double);
  }
  return total;
}

std::size_t ExchangeMatrix::denseRows() const {
  return std::size_t(
      std::count_if(rows_.begin(), rows_.end(), [](const Row& r) { return r.dense; }));
}

std::vector<double> ExchangeMatrix::rowSums() const {
  const std::vector<double> ones(size(), 1.0);
  std::vector<double> sums(size());
  product(ones, 1, sums);
  return sums;
}

std::size_t ExchangeMatrix::estimateBytes(std::size_t n, double entries_per_row,
                                          Precision precision) {
  const auto value_bytes = double(valueBytes(precision));
  const double sparse = entries_per_row * (value_bytes + sizeof(Index));
  const double dense = double(n) * value_bytes;
  return std::size_t(std::ceil(double(n) * std::min(sparse, dense)));
}

}  // namespace radiosity
