// How rows are set and read entry by entry.
#include "radiosity/symmetric_matrix.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "base/scratch_rows.h"
#include "matrix/own_rows.h"
#include "matrix/run_row.h"

namespace radiosity {

namespace {

/// Rows that a thread counts at a time.
constexpr std::size_t kCountedTriangleRows = 64;
/// The largest value that may be stored: a sum of N of them cannot overflow.
constexpr double kLargest = 1e30;

}  // namespace

SymmetricMatrix::SymmetricMatrix(std::vector<double> area, std::vector<Index> order,
                                 Precision precision, std::shared_ptr<ScratchMemory> scratch)
    : ExchangeMatrix(std::move(area), true, std::move(order), precision),
      scratch_(std::move(scratch)),
      position_(size()),
      diagonal_(size(), 0.0) {
  upper_.reserve(size());
  for (std::size_t k = 0; k < size(); ++k) {
    const Index patch = ExchangeMatrix::order()[k];
    position_[patch] = Index(k);
    if (ExchangeMatrix::area()[patch] == 0) without_area_.push_back(Index(k));
    upper_.emplace_back(rowMemory(scratch_.get()));
  }
}
SymmetricMatrix::SymmetricMatrix(SymmetricMatrix&&) noexcept = default;
SymmetricMatrix::~SymmetricMatrix() = default;

void SymmetricMatrix::checkFactors(std::size_t k, std::span<const double> factors) const {
  if (k >= size() || factors.size() > size() - k) {
    throw InputError(
        fmt::format("exchange matrix: {} factors for row {} of the upper triangle of {}",
                    factors.size(), k, size()));
  }
  const auto refuse = [&](std::size_t m) {
    throw InputError(fmt::format("exchange matrix: {} is no form factor from patch {} to patch {}",
                                 factors[m], order()[k], order()[k + m]));
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
  if (area()[order()[k]] > 0) return;
  for (std::size_t m = 0; m < factors.size(); ++m) {
    if (factors[m] != 0) refuse(m);
  }
}

void SymmetricMatrix::checkPositions(std::size_t k, std::span<const Index> positions,
                                     std::span<const double> factors) const {
  if (k >= size() || positions.size() != factors.size()) {
    throw InputError(
        fmt::format("exchange matrix: {} positions and {} factors for row {} of the upper triangle "
                    "of {}",
                    positions.size(), factors.size(), k, size()));
  }
  for (std::size_t m = 0; m < positions.size(); ++m) {
    const Index position = positions[m];
    if (position < k || position >= size() || (m > 0 && position <= positions[m - 1])) {
      throw InputError(
          fmt::format("exchange matrix, row {} of the upper triangle: position {} is "
                      "out of order or not from {} to {}",
                      k, position, k, size()));
    }
    const bool exchanges = area()[order()[k]] > 0 && area()[order()[position]] > 0;
    if (factors[m] >= 0 && factors[m] <= (exchanges ? kLargest : 0.0)) continue;
    throw InputError(fmt::format("exchange matrix: {} is no form factor from patch {} to patch {}",
                                 factors[m], order()[k], order()[position]));
  }
}

void SymmetricMatrix::setUpperRow(std::size_t k, std::span<const double> factors) {
  checkFactors(k, factors);
  if (factors.empty()) return storeUpper(k, 0, {});
  storeUpper(k, factors[0], packRuns(factors.subspan(1), precision()));
}

void SymmetricMatrix::setUpperRow(std::size_t k, std::span<const Index> positions,
                                  std::span<const double> factors) {
  checkPositions(k, positions, factors);
  const bool itself = !positions.empty() && positions[0] == k;
  const std::size_t later = itself ? 1 : 0;
  storeUpper(k, itself ? factors[0] : 0.0,
             packRuns(positions.subspan(later), k + 1, factors.subspan(later), precision()));
}

void SymmetricMatrix::storeUpper(std::size_t k, double itself, RunRow row) {
  upper_[k] = std::move(row);
  touchRows(scratch_.get(), bytesOf(upper_[k]));
  diagonal_[k] = precision() == Precision::single_precision ? double(float(itself)) : itself;
}

void SymmetricMatrix::upperRow(std::size_t k, std::span<double> factors) const {
  std::fill(factors.begin(), factors.end(), 0.0);
  factors[0] = diagonal_[k];
  forRuns(upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
    std::copy(values, values + count, factors.begin() + std::ptrdiff_t(1 + offset));
  });
}

SymmetricMatrix::UpperEntries SymmetricMatrix::upperEntries(std::size_t k) const {
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

const RunRow& SymmetricMatrix::upperRuns(std::size_t k) const {
  touchRows(scratch_.get(), bytesOf(upper_[k]));
  return upper_[k];
}

double SymmetricMatrix::storedUpper(std::size_t k, std::size_t later) const {
  return k == later ? diagonal_[k] : RunReader(upper_[k]).at(later - k - 1);
}

double SymmetricMatrix::at(std::size_t i, std::size_t j) const {
  if (position_[i] <= position_[j]) return storedUpper(position_[i], position_[j]);
  const double mirrored = storedUpper(position_[j], position_[i]);
  return mirrored == 0 ? 0 : mirrored * area()[j] / area()[i];
}

std::vector<Index> SymmetricMatrix::rowEntries() const {
  std::vector<Index> entries(size(), 0);
  tbb::enumerable_thread_specific<std::vector<Index>> counts(std::vector<Index>(upper_.size(), 0));
  parallelFor(upper_.size(), kCountedTriangleRows, [&](std::size_t k) {
    std::vector<Index>& count = counts.local();
    Index own = diagonal_[k] != 0 ? 1 : 0;
    forRuns(upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t length) {
      const Index* later = &order()[k] + 1 + offset;
      for (std::size_t m = 0; m < length; ++m) {
        const Index stored = values[m] != 0 ? 1 : 0;
        own += stored;
        count[later[m]] += stored;
      }
    });
    count[order()[k]] += own;
  });
  for (const std::vector<Index>& count : counts) {
    for (std::size_t i = 0; i < count.size(); ++i) entries[i] += count[i];
  }
  return entries;
}

std::size_t SymmetricMatrix::bytes() const {
  std::size_t total = diagonal_.size() * sizeof(double);
  for (const RunRow& row : upper_) total += bytesOf(row);
  return total;
}

SymmetricMatrix::Rooms SymmetricMatrix::rooms() const { return roomsOf(joinedBy(*this), order()); }

}  // namespace radiosity
