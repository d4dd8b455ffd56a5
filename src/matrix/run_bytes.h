// Runs as bytes, for rows that go to a file or to another process, and back.
#pragma once

#include <cstddef>
#include <span>

#include "base/byte_stream.h"
#include "matrix/run_row.h"

namespace radiosity {

template <class Value>
void putRuns(const std::pmr::vector<Run>& runs, const std::pmr::vector<Value>& values,
             ByteWriter& bytes) {
  std::size_t stored = 0;
  for (const Run run : runs) stored += run.count;
  bytes.putArray(std::span(runs));
  bytes.putArray(std::span(values).first(stored));  // without the zeros that kernels read beyond
}

inline void putRuns(const RunRow& row, Precision precision, ByteWriter& bytes) {
  if (precision == Precision::single_precision) {
    putRuns(row.runs, row.floats, bytes);
  } else {
    putRuns(row.runs, row.doubles, bytes);
  }
}

/// Calls visit(offset, value) for every stored value with an offset below `end`.
template <class Value, class Visit>
void takeRuns(ByteReader& bytes, std::size_t end, const Visit& visit) {
  const auto runs = bytes.getArray<Run>();
  const auto values = bytes.getArray<Value>();
  std::size_t offset = 0;
  std::size_t next = 0;
  for (const Run run : runs) {
    offset += run.skip;
    for (std::size_t m = 0; m < run.count && next < values.size() && offset < end; ++m) {
      visit(offset++, values[next++]);
    }
  }
}

/// The same for a row of this precision.
template <class Visit>
void takeRuns(ByteReader& bytes, Precision precision, std::size_t end, const Visit& visit) {
  if (precision == Precision::single_precision) {
    takeRuns<float>(bytes, end, visit);
  } else {
    takeRuns<double>(bytes, end, visit);
  }
}

}  // namespace radiosity
