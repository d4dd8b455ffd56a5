// The symmetric form of the exchange matrix: how rows are set and read entry by entry.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/scratch_rows.h"
#include "matrix/matrix_row.h"
#include "matrix/run_row.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

namespace {

/// The largest value that may be stored: a sum of N of them cannot overflow.
constexpr double kLargest = 1e30;

}  // namespace

ExchangeMatrix ExchangeMatrix::symmetric(std::vector<double> area, std::vector<Index> order,
                                         Precision precision,
                                         std::shared_ptr<ScratchMemory> scratch) {
  ExchangeMatrix matrix(std::move(area), precision, std::move(scratch));
  const std::size_t n = matrix.size();
  matrix.symmetric_ = true;
  matrix.rows_ = {};
  matrix.position_.assign(n, kNone);
  if (order.size() != n) {
    throw InputError(
        fmt::format("exchange matrix: an order of {} patches for {}", order.size(), n));
  }
  for (std::size_t k = 0; k < n; ++k) {
    if (order[k] >= n || matrix.position_[order[k]] != kNone) {
      throw InputError(
          fmt::format("exchange matrix: the order names patch {} twice or beyond {}", order[k], n));
    }
    matrix.position_[order[k]] = Index(k);
    if (matrix.area_[order[k]] == 0) matrix.without_area_.push_back(Index(k));
  }
  matrix.order_ = std::move(order);
  matrix.upper_.reserve(n);
  std::pmr::memory_resource* const memory = rowMemory(matrix.scratch_.memory.get());
  for (std::size_t k = 0; k < n; ++k) matrix.upper_.emplace_back(memory);
  matrix.diagonal_.assign(n, 0.0);
  return matrix;
}

void ExchangeMatrix::checkFactors(std::size_t k, std::span<const double> factors) const {
  requireRows("setting a row");
  if (!symmetric_ || k >= size() || factors.size() > size() - k) {
    throw InputError(
        fmt::format("exchange matrix: {} factors for row {} of the upper triangle of {}",
                    factors.size(), k, symmetric_ ? size() : 0));
  }
  const auto refuse = [&](std::size_t m) {
    throw InputError(fmt::format("exchange matrix: {} is no form factor from patch {} to patch {}",
                                 factors[m], order_[k], order_[k + m]));
  };
  // A negative value sets the top bit of `bad`, and so does one above the largest, infinity and NaN
  // included: numbers of one sign are ordered like their bits. The loop runs over every entry, so
  // it has no exit and no comparison: the compiler vectorises it.
  std::uint64_t bad = 0;
  for (const double value : factors) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    bad |= bits | (std::bit_cast<std::uint64_t>(kLargest) - bits);
  }
  for (std::size_t m = 0; (bad >> 63U) != 0 && m < factors.size(); ++m) {
    if (!(factors[m] >= 0 && factors[m] <= kLargest)) refuse(m);
  }
  for (const Index later : without_area_) {
    if (later < k || later >= k + factors.size()) continue;
    if (factors[later - k] != 0) refuse(later - k);
  }
  if (area_[order_[k]] > 0) return;
  for (std::size_t m = 0; m < factors.size(); ++m) {
    if (factors[m] != 0) refuse(m);
  }
}

void ExchangeMatrix::checkPositions(std::size_t k, std::span<const Index> positions,
                                    std::span<const double> factors) const {
  requireRows("setting a row");
  if (!symmetric_ || k >= size() || positions.size() != factors.size()) {
    throw InputError(
        fmt::format("exchange matrix: {} positions and {} factors for row {} of the upper triangle "
                    "of {}",
                    positions.size(), factors.size(), k, symmetric_ ? size() : 0));
  }
  for (std::size_t m = 0; m < positions.size(); ++m) {
    const Index position = positions[m];
    if (position < k || position >= size() || (m > 0 && position <= positions[m - 1])) {
      throw InputError(
          fmt::format("exchange matrix, row {} of the upper triangle: position {} is "
                      "out of order or not from {} to {}",
                      k, position, k, size()));
    }
    const bool exchanges = area_[order_[k]] > 0 && area_[order_[position]] > 0;
    if (factors[m] >= 0 && factors[m] <= (exchanges ? kLargest : 0.0)) continue;
    throw InputError(fmt::format("exchange matrix: {} is no form factor from patch {} to patch {}",
                                 factors[m], order_[k], order_[position]));
  }
}

void ExchangeMatrix::setUpperRow(std::size_t k, std::span<const double> factors) {
  checkFactors(k, factors);
  if (factors.empty()) return storeUpper(k, 0, {});
  storeUpper(k, factors[0], packRuns(factors.subspan(1), precision_));
}

void ExchangeMatrix::setUpperRow(std::size_t k, std::span<const Index> positions,
                                 std::span<const double> factors) {
  checkPositions(k, positions, factors);
  const bool itself = !positions.empty() && positions[0] == k;
  const std::size_t later = itself ? 1 : 0;
  storeUpper(k, itself ? factors[0] : 0.0,
             packRuns(positions.subspan(later), k + 1, factors.subspan(later), precision_));
}

void ExchangeMatrix::storeUpper(std::size_t k, double itself, RunRow row) {
  upper_[k] = std::move(row);
  touchRows(scratch_.memory.get(), bytesOf(upper_[k]));
  diagonal_[k] = precision_ == Precision::single_precision ? double(float(itself)) : itself;
}

void ExchangeMatrix::upperRow(std::size_t k, std::span<double> factors) const {
  std::fill(factors.begin(), factors.end(), 0.0);
  factors[0] = diagonal_[k];
  forRuns(upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
    std::copy(values, values + count, factors.begin() + std::ptrdiff_t(1 + offset));
  });
}

ExchangeMatrix::UpperEntries ExchangeMatrix::upperEntries(std::size_t k) const {
  UpperEntries entries;
  const auto add = [&](std::size_t position, double factor) {
    if (factor == 0) return;
    entries.positions.push_back(Index(position));
    entries.factors.push_back(factor);
  };
  add(k, diagonal_[k]);
  forRuns(upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
    for (std::size_t m = 0; m < count; ++m) add(k + 1 + offset + m, values[m]);
  });
  return entries;
}

const RunRow& ExchangeMatrix::upperRuns(std::size_t k) const {
  requireRows("what walks along stored rows");
  touchRows(scratch_.memory.get(), bytesOf(upper_[k]));
  return upper_[k];
}

double ExchangeMatrix::storedUpper(std::size_t k, std::size_t later) const {
  return k == later ? diagonal_[k] : RunReader(upper_[k]).at(later - k - 1);
}

}  // namespace radiosity
