// What may be asked of surfaces.
#pragma once

#include <span>

#include "radiosity/heat.h"

namespace radiosity {

/// Errors: InputError naming the condition, for a value out of range, for two of temperature, flux
/// and power, and for emissivities that are neither one nor `bands`.
void validate(std::span<const HeatCondition> conditions, int bands);

/// True where flux, power or convection decide the temperature.
inline bool isFree(const HeatCondition& condition) { return !condition.temperature; }

inline const Emissivity& emissivityIn(const HeatCondition& condition, std::size_t band) {
  return condition.emissivity[condition.emissivity.size() == 1 ? 0 : band];
}

}  // namespace radiosity
