// A proof that the radiosities are as good as they are said to be.
#pragma once

#include <optional>

#include "solve/iteration.h"

namespace radiosity {

/// An upper bound of |B - B*|_inf, W/m^2, in the worst band, B* being the exact solution for this
/// very matrix; the rounding of the residual itself is in it. Empty: no certificate was found
/// with the work of `max_sweeps` sweeps, as where the spectral radius of rho F is 1 or above.
std::optional<double> certifiedErrorBound(const System& system, const Fields& fields,
                                          int max_sweeps, Progress& progress);

}  // namespace radiosity
