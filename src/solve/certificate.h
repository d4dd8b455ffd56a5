// A proved bound on the error of the radiosities.
#pragma once

#include <optional>

#include "solve/iteration.h"

namespace radiosity {

/// An upper bound of |B - B*|_inf, W/m^2, in the worst band; B* is the exact solution for this
/// matrix. The bound includes the rounding of the residual itself. Empty: no certificate was found
/// with the work of `max_sweeps` sweeps, for example because the spectral radius of rho F is >= 1.
std::optional<double> certifiedErrorBound(const System& system, const Fields& fields,
                                          int max_sweeps, Progress& progress);

}  // namespace radiosity
