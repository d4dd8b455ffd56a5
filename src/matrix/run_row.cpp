#include "matrix/run_row.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include "matrix/triangle_kernels.h"

namespace radiosity {

namespace {

constexpr std::size_t kLongest = std::numeric_limits<std::uint16_t>::max();

/// The number of values tested together, as integers, in loops without an exit, which the compiler
/// vectorises.
constexpr std::size_t kBlock = 16;

template <class Value>
struct Block {
  using Bits =
      std::conditional_t<sizeof(Value) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
  explicit Block(const Value* values) { std::memcpy(bits.data(), values, sizeof bits); }
  bool allZero() const {
    Bits any = 0;
    for (const Bits b : bits) any |= b;
    return any == 0;
  }
  bool noneZero() const {
    Bits all = ~Bits(0);
    for (const Bits b : bits) all &= b | (Bits(0) - b);  // the top bit is set unless b is 0
    return (all >> (std::numeric_limits<Bits>::digits - 1)) != 0;
  }
  std::array<Bits, kBlock> bits;
};

template <class Value>
std::pmr::vector<Run> findRuns(const Value* values, std::size_t n) {
  RunFinder finder(sizeof(Value));
  for (std::size_t first = 0;;) {
    while (first + kBlock <= n && Block(values + first).allZero()) first += kBlock;
    while (first < n && values[first] == 0) ++first;
    if (first == n) break;
    std::size_t last = first + 1;
    while (last + kBlock <= n && Block(values + last).noneZero()) last += kBlock;
    while (last < n && values[last] != 0) ++last;
    finder.add(first, last);
    first = last;
  }
  return finder.take();
}

/// Rounds before it looks for zeros: values that round to 0 are not stored.
template <class Value>
void pack(std::span<const double> values, std::pmr::vector<Run>& runs,
          std::pmr::vector<Value>& stored) {
  const std::size_t n = values.size();
  const auto rounded = std::make_unique_for_overwrite<Value[]>(n);
  for (std::size_t m = 0; m < n; ++m) rounded[m] = Value(values[m]);
  runs = findRuns(rounded.get(), n);
  std::size_t total = 0;
  for (const Run run : runs) total += run.count;
  if (total == 0) return;
  stored.reserve(total + kOverrun);
  const Value* from = rounded.get();
  for (const Run run : runs) {
    from += run.skip;
    stored.insert(stored.end(), from, from + run.count);
    from += run.count;
  }
  stored.resize(total + kOverrun, Value(0));
}

/// The same for values at some places.
template <class Value>
void pack(std::span<const Index> places, std::size_t first, std::span<const double> values,
          std::pmr::vector<Run>& runs, std::pmr::vector<Value>& stored) {
  RunFinder finder(sizeof(Value));
  for (std::size_t m = 0; m < values.size(); ++m) {
    if (Value(values[m]) != 0) finder.add(places[m] - first, places[m] - first + 1);
  }
  runs = finder.take();
  std::size_t total = 0;
  for (const Run run : runs) total += run.count;
  if (total == 0) return;
  stored.resize(total + kOverrun, Value(0));
  std::size_t m = 0;
  forRuns(std::span<const Run>(runs), stored.data(),
          [&](std::size_t offset, Value* run, std::size_t count) {
            for (; m < values.size() && places[m] - first < offset + count; ++m) {
              if (places[m] - first >= offset) run[places[m] - first - offset] = Value(values[m]);
            }
          });
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

std::pmr::vector<Run> RunFinder::take() {
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
  if (precision == Precision::single_precision) {
    pack(values, row.runs, row.floats);
  } else {
    pack(values, row.runs, row.doubles);
  }
  return row;
}

RunRow packRuns(std::span<const Index> places, std::size_t first, std::span<const double> values,
                Precision precision) {
  RunRow row;
  if (precision == Precision::single_precision) {
    pack(places, first, values, row.runs, row.floats);
  } else {
    pack(places, first, values, row.runs, row.doubles);
  }
  return row;
}

std::size_t bytesOf(const RunRow& row) {
  return row.runs.size() * sizeof(Run) + row.floats.size() * sizeof(float) +
         row.doubles.size() * sizeof(double);
}

}  // namespace radiosity
