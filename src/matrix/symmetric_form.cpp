// The symmetric form of the exchange matrix: what goes in and how it is read entry by entry.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "matrix/matrix_row.h"
#include "matrix/run_row.h"
#include "radiosity/exchange_matrix.h"

namespace radiosity {

namespace {

constexpr std::size_t kRowGrain = 16;

/// Largest stored value, so that a sum of N of them cannot overflow.
constexpr double kLargest = 1e30;

}  // namespace

ExchangeMatrix ExchangeMatrix::symmetric(std::vector<double> area, std::vector<Index> order,
                                         Precision precision) {
  ExchangeMatrix matrix(std::move(area), precision);
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
  matrix.upper_.resize(n);
  matrix.diagonal_.assign(n, 0.0);
  return matrix;
}

void ExchangeMatrix::checkFactors(std::size_t k, std::span<const double> factors) const {
  if (!symmetric_ || k >= size() || factors.size() > size() - k) {
    throw InputError(
        fmt::format("exchange matrix: {} factors for row {} of the upper triangle of {}",
                    factors.size(), k, symmetric_ ? size() : 0));
  }
  const auto refuse = [&](std::size_t m) {
    throw InputError(fmt::format("exchange matrix: {} is no form factor from patch {} to patch {}",
                                 factors[m], order_[k], order_[k + m]));
  };
  // The top bit of `bad` is set by a negative value and by one above the largest, infinity and NaN
  // included: numbers of one sign are ordered as their bits are. No exit and no comparison: this
  // loop runs over every entry there is, and so it is made of vectors.
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

void ExchangeMatrix::setUpperRow(std::size_t k, std::span<const double> factors) {
  checkFactors(k, factors);
  if (factors.empty()) {
    upper_[k] = {};
    diagonal_[k] = 0;
    return;
  }
  upper_[k] = packRuns(factors.subspan(1), precision_);
  diagonal_[k] = precision_ == Precision::single_precision ? double(float(factors[0])) : factors[0];
}

void ExchangeMatrix::upperRow(std::size_t k, std::span<double> factors) const {
  std::fill(factors.begin(), factors.end(), 0.0);
  factors[0] = diagonal_[k];
  forRuns(upper_[k], [&](std::size_t offset, const auto* values, std::size_t count) {
    std::copy(values, values + count, factors.begin() + std::ptrdiff_t(1 + offset));
  });
}

const RunRow& ExchangeMatrix::upperRuns(std::size_t k) const { return upper_[k]; }

double ExchangeMatrix::storedUpper(std::size_t k, std::size_t later) const {
  return k == later ? diagonal_[k] : RunReader(upper_[k]).at(later - k - 1);
}

std::size_t ExchangeMatrix::panelEnd(std::size_t first) const {
  const std::size_t rows = kPanelBytes / (sizeof(double) * size());
  return std::min(size(), first + std::max<std::size_t>(rows, 1));
}

// Row i of F holds what row position(i) of the triangle stores, and, from every row k before it,
// the one value at its own position. The second part touches all rows of the triangle above: all
// rows of a panel are served while such a row is at hand, found in one walk along its runs.
void ExchangeMatrix::spreadRows(std::size_t first, std::size_t last, std::span<double> out) const {
  const std::size_t n = size();
  std::vector<std::pair<Index, Index>> wanted;  // position, row of the panel
  for (std::size_t i = first; i < last; ++i) wanted.emplace_back(position_[i], Index(i - first));
  std::sort(wanted.begin(), wanted.end());
  parallelFor(wanted.size(), 1, [&](std::size_t w) {
    const std::size_t k = wanted[w].first;
    std::vector<double> stored(n - k);
    upperRow(k, stored);
    double* spread = &out[wanted[w].second * n];
    for (std::size_t m = 0; m < stored.size(); ++m) spread[order_[k + m]] = stored[m];
  });
  parallelFor(wanted.empty() ? 0 : wanted.back().first, kRowGrain, [&](std::size_t k) {
    const Index patch = order_[k];
    RunReader stored(upper_[k]);
    auto next = std::upper_bound(wanted.begin(), wanted.end(), std::pair(Index(k), kNone));
    for (; next != wanted.end(); ++next) {
      const double value = stored.at(next->first - k - 1);
      // The area of a patch that exchanges nothing may be 0.
      out[next->second * n + patch] =
          value == 0 ? 0 : value * area_[patch] / area_[order_[next->first]];
    }
  });
}

}  // namespace radiosity
