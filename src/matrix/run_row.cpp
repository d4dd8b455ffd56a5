#include "matrix/run_row.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace radiosity {

namespace {

constexpr std::size_t kLongest = std::numeric_limits<std::uint16_t>::max();

template <class Value>
std::vector<Run> findRuns(std::span<const double> values) {
  RunFinder finder(sizeof(Value));
  const std::size_t n = values.size();
  // Value(v) rather than v: what rounds to 0 is 0.
  for (std::size_t first = 0;;) {
    while (first < n && Value(values[first]) == 0) ++first;
    if (first == n) break;
    std::size_t last = first + 1;
    while (last < n && Value(values[last]) != 0) ++last;
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
  stored.reserve(total);
  const double* from = values.data();
  for (const Run run : runs) {
    from += run.skip;
    stored.insert(stored.end(), from, from + run.count);
    from += run.count;
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
