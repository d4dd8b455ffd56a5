// Bytes of values, and those expected of a symmetric matrix of a scene; estimateSymmetricBytes() is
// the upper bound.
#pragma once

#include <cstddef>

#include "radiosity/exchange_operator.h"

namespace radiosity {

inline std::size_t valueBytes(Precision precision) {
  return precision == Precision::single_precision ? sizeof(float) : sizeof(double);
}

/// The bytes of N rows with `entries_per_row` entries on both sides of the diagonal. It assumes
/// that patches next to each other in the order are mostly seen together: a run of values begins
/// after (1 - 3/2 f)^2 of the entries, where f is the share of the row that they fill. (Fitted to
/// six scenes with f from 0.07 to 0.5: off by 9% at most.)
std::size_t expectedSymmetricBytes(std::size_t n, double entries_per_row, Precision precision);

/// The same for the errors of these entries (UncertainEntries). Their runs bridge longer gaps: one
/// begins after (1 - 3/2 f)^4 of the entries.
std::size_t expectedUncertainBytes(std::size_t n, double entries_per_row);

}  // namespace radiosity
