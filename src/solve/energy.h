// Where the light goes.
#pragma once

#include <span>

#include "radiosity/solve.h"

namespace radiosity {

/// The account of B = `radiosity`, H = `irradiance`, all N * bands, row-major.
EnergyAccount energyAccount(const FormFactors& factors, std::span<const double> reflectance,
                            std::span<const double> emission, std::span<const double> radiosity,
                            std::span<const double> irradiance, int bands);

}  // namespace radiosity
