#include "matrix/run_row.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <vector>

namespace radiosity {

namespace {

constexpr std::size_t kLongest = std::numeric_limits<std::uint16_t>::max();

/// Values looked at together: stretches of zeros and of others are long, or there would be nothing
/// to gain from runs.
constexpr std::size_t kBlock = 32;

/// Largest number that is 0 once it is stored as Value: half of the smallest subnormal.
template <class Value>
constexpr double kRoundsToZero = std::is_same_v<Value, float> ? 0x1p-150 : 0.0;

/// The top bit is set where a value (0 or more) is not 0 once it is stored: numbers of one sign are
/// ordered as their bits are, and a difference of whole numbers is what compilers make vectors of.
template <class Value>
std::uint64_t isStored(double value) {
  return std::bit_cast<std::uint64_t>(kRoundsToZero<Value>) - std::bit_cast<std::uint64_t>(value);
}

/// Where the stretch of zeros (`zero`) or of other values that goes on at `from` ends.
template <class Value>
std::size_t endOfStretch(std::span<const double> values, std::size_t from, bool zero) {
  constexpr std::uint64_t kTop = std::uint64_t(1) << 63U;
  const std::size_t n = values.size();
  for (; from + kBlock <= n; from += kBlock) {
    std::uint64_t any = 0;
    std::uint64_t all = kTop;
    for (std::size_t k = 0; k < kBlock; ++k) {
      const std::uint64_t stored = isStored<Value>(values[from + k]);
      any |= stored;
      all &= stored;
    }
    if (((zero ? ~any : all) & kTop) == 0) break;
  }
  while (from < n && ((isStored<Value>(values[from]) & kTop) == 0) == zero) ++from;
  return from;
}

template <class Value>
std::vector<Run> findRuns(std::span<const double> values) {
  RunFinder finder(sizeof(Value));
  for (std::size_t first = 0;;) {
    first = endOfStretch<Value>(values, first, true);
    if (first == values.size()) break;
    const std::size_t last = endOfStretch<Value>(values, first, false);
    finder.add(first, last);
    first = last;
  }
  return finder.take();
}

template <class Value>
void pack(std::span<const double> values, std::vector<Run>& runs, std::vector<Value>& stored) {
  runs = findRuns<Value>(values);
  std::size_t total = 0;
  for (const Run run : runs) total += run.count;
  stored.resize(total);
  const double* from = values.data();
  Value* to = stored.data();
  for (const Run run : runs) {
    from += run.skip;
    for (std::size_t k = 0; k < run.count; ++k) to[k] = Value(from[k]);
    from += run.count;
    to += run.count;
  }
}

}  // namespace

void RunFinder::add(std::size_t first, std::size_t last) {
  if (end_ > 0 && first - end_ <= bridge_) {
    first = end_;
  } else {
    skip(first - end_);
  }
  extend(last - first);
  end_ = last;
}

std::vector<Run> RunFinder::take() {
  runs_.shrink_to_fit();
  return std::move(runs_);
}

void RunFinder::skip(std::size_t zeros) {
  for (; zeros > kLongest; zeros -= kLongest) runs_.push_back({std::uint16_t(kLongest), 0});
  runs_.push_back({std::uint16_t(zeros), 0});
}

void RunFinder::extend(std::size_t count) {
  while (count > 0) {
    if (runs_.back().count == kLongest) runs_.push_back({0, 0});
    const std::size_t now = std::min(count, kLongest - runs_.back().count);
    runs_.back().count = std::uint16_t(runs_.back().count + now);
    count -= now;
  }
}

RunRow packRuns(std::span<const double> values, Precision precision) {
  RunRow row;
  if (precision == Precision::single) {
    pack(values, row.runs, row.single);
  } else {
    pack(values, row.runs, row.real);
  }
  return row;
}

std::size_t bytesOf(const RunRow& row) {
  return row.runs.size() * sizeof(Run) + row.single.size() * sizeof(float) +
         row.real.size() * sizeof(double);
}

}  // namespace radiosity
