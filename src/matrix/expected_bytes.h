// What a symmetric matrix of a scene will take, about: estimateSymmetricBytes() says at most.
#pragma once

#include <cstddef>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// Bytes of N rows with `entries_per_row` entries, both sides of the diagonal counted, where what
/// lies together in the order is mostly seen together: a run of values begins after (1 - 3/2 f)^2
/// of the entries, f being the share of the row that they fill. (Fitted to six scenes, at 0.07 to
/// 0.5: off by 9% at most.)
std::size_t expectedSymmetricBytes(std::size_t n, double entries_per_row, Precision precision);

/// The same of the errors of all these entries (UncertainEntries), whose runs bridge longer gaps:
/// (1 - 3/2 f)^4 of the entries.
std::size_t expectedUncertainBytes(std::size_t n, double entries_per_row);

}  // namespace radiosity
