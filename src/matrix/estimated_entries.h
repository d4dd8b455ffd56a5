// The errors of entries that are estimates all alike, for closure.
#pragma once

#include <cstdint>
#include <span>

#include "radiosity/closure.h"

namespace radiosity {

/// The smallest area above 0.
double smallestArea(std::span<const double> area);

/// The errors of a symmetric matrix's entries: their squares go with the exchange area, as in van
/// Leersum's closure (closure.h). Those in the rows of `known` patches (N flags, or empty: none),
/// and on the diagonal, have none. The unit, the smallest area, keeps errors of F below 1.
UncertainEntries estimatedEntries(const SymmetricMatrix& matrix,
                                  std::span<const std::uint8_t> known = {});

}  // namespace radiosity
