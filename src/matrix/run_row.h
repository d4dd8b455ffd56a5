// A row of a triangle as runs of stored values between zeros that are left out.
#pragma once

#include <cstddef>
#include <span>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// The smallest RunRow of `values`: zeros between two stored values are stored only where that is
/// shorter than a new run.
RunRow packRuns(std::span<const double> values, Precision precision);

/// Calls visit(offset, values, count) for every run with stored values, values being float or
/// double.
template <class Visit>
void forRuns(const RunRow& row, Visit&& visit) {
  const auto walk = [&](const auto* values) {
    std::size_t offset = 0;
    for (const RunRow::Run run : row.runs) {
      offset += run.skip;
      if (run.count > 0) visit(offset, values, std::size_t(run.count));
      offset += run.count;
      values += run.count;
    }
  };
  if (row.real.empty()) {
    walk(row.single.data());
  } else {
    walk(row.real.data());
  }
}

/// The value at `offset`, 0 where nothing is stored.
double valueAt(const RunRow& row, std::size_t offset);

std::size_t bytesOf(const RunRow& row);

}  // namespace radiosity
