// The energy account of a solution.
#pragma once

#include <span>

#include "radiosity/solve.h"

namespace radiosity {

/// Incoming light: E, and irradiance by lights without a surface; N * bands, row-major, W/m^2.
struct Incoming {
  std::span<const double> emission;
  std::span<const double> by_lights;
};

/// The account of B = `radiosity`, H = `irradiance`, all N * bands, row-major.
EnergyAccount energyAccount(const FormFactors& factors, std::span<const double> reflectance,
                            const Incoming& incoming, std::span<const double> radiosity,
                            std::span<const double> irradiance, int bands);

/// Makes a converged solution `unbalanced`, with a message, if its account is off by more than
/// mostImbalance() and what its residual explains. `emission`: as solved.
void judgeBalance(const FormFactors& factors, std::span<const double> emission,
                  SolveSummary& summary);

}  // namespace radiosity
