// A row of a triangle as runs of stored values; the zeros between them are left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "radiosity/exchange_operator.h"

namespace radiosity {

/// `skip` zeros that are left out and then `count` stored values. Longer stretches are several
/// runs.
struct Run {
  std::uint16_t skip = 0;
  std::uint16_t count = 0;
};

/// One row of a triangle as runs. The values are in `floats` or in `doubles`, by precision.
struct RunRow {
  RunRow() = default;
  /// The row keeps the resource `memory` when another row is assigned to it.
  explicit RunRow(std::pmr::memory_resource* memory)
      : runs(memory), floats(memory), doubles(memory) {}

  std::pmr::vector<Run> runs;
  std::pmr::vector<float> floats;
  std::pmr::vector<double> doubles;
};

/// The smallest RunRow of `values`: zeros between two stored values are stored only if that is no
/// longer than a new run. kOverrun zeros follow the values (triangle_kernels.h).
RunRow packRuns(std::span<const double> values, Precision precision);

/// The same for a row with values at `places`, which strictly increase and are counted from `first`
/// on; all others are 0. O(values).
RunRow packRuns(std::span<const Index> places, std::size_t first, std::span<const double> values,
                Precision precision);

/// Collects the stretches of values to store, in order, as the shortest list of runs.
class RunFinder {
 public:
  /// Zeros are stored if that takes no more bytes than a new run.
  explicit RunFinder(std::size_t value_bytes) : bridge_(sizeof(Run) / value_bytes) {}
  /// Adds values [first, last) to store; all values between the last call and these are 0.
  void add(std::size_t first, std::size_t last);
  std::pmr::vector<Run> take();

 private:
  void skip(std::size_t zeros);
  void extend(std::size_t count);

  std::size_t bridge_;
  std::size_t end_ = 0;  // one beyond the last value that is stored
  std::pmr::vector<Run> runs_;
};

/// Calls visit(offset, values, count) for every run with stored values.
template <class Value, class Visit>
void forRuns(std::span<const Run> runs, Value* values, Visit&& visit) {
  std::size_t offset = 0;
  for (const Run run : runs) {
    offset += run.skip;
    if (run.count > 0) visit(offset, values, std::size_t(run.count));
    offset += run.count;
    values += run.count;
  }
}

/// The same for a row, `values` being float or double.
template <class Visit>
void forRuns(const RunRow& row, Visit&& visit) {
  if (row.doubles.empty()) {
    forRuns(std::span(row.runs), row.floats.data(), visit);
  } else {
    forRuns(std::span(row.runs), row.doubles.data(), visit);
  }
}

/// Reads a row at offsets that do not decrease, in one walk.
class RunReader {
 public:
  explicit RunReader(const RunRow& row) : row_(&row) {
    if (!row.runs.empty()) begin_ = row.runs[0].skip;
  }
  /// 0 where nothing is stored.
  double at(std::size_t offset) {
    const std::pmr::vector<Run>& runs = row_->runs;
    while (run_ < runs.size() && offset >= begin_ + runs[run_].count) {
      stored_ += runs[run_].count;
      begin_ += runs[run_].count;
      if (++run_ < runs.size()) begin_ += runs[run_].skip;
    }
    if (run_ == runs.size() || offset < begin_) return 0;
    const std::size_t k = stored_ + (offset - begin_);
    return row_->doubles.empty() ? double(row_->floats[k]) : row_->doubles[k];
  }

 private:
  const RunRow* row_;
  std::size_t run_ = 0;
  std::size_t begin_ = 0;   // offset of the run's first value
  std::size_t stored_ = 0;  // values before it
};

std::size_t bytesOf(const RunRow& row);

/// The work of a walk along the row; 0 if nothing is stored.
inline std::size_t workOf(const RunRow& row) {
  return row.floats.size() + row.doubles.size() + row.runs.size();
}

}  // namespace radiosity
