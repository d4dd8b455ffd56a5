// Checks of conditions.
#pragma once

#include <span>

#include "radiosity/heat.h"

namespace radiosity {

/// W/m^2, of a black surface at kHottest.
inline constexpr double kMostFlux = 5.67e24;
/// W, W/m^2/K.
inline constexpr double kMostPower = 1e30;
inline constexpr double kMostConvection = 1e15;

/// Errors: InputError naming the condition, for a value out of range, for two of temperature, flux
/// and power, and for emissivities that are neither one nor `bands`.
void validate(std::span<const HeatCondition> conditions, int bands);

/// True if flux, power or convection decide the temperature.
inline bool isFree(const HeatCondition& condition) { return !condition.temperature; }

inline const Emissivity& emissivityIn(const HeatCondition& condition, std::size_t band) {
  return condition.emissivity[condition.emissivity.size() == 1 ? 0 : band];
}

/// Its derivative, 1/K: 0 for a constant and beyond the table.
double slopeOf(const Emissivity& emissivity, double temperature);

}  // namespace radiosity
