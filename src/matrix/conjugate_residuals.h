// Conjugate residuals: an iteration for symmetric systems that may have no solution.
#pragma once

#include <functional>
#include <vector>

#include "matrix/strong_pairs.h"
#include "radiosity/base.h"

namespace radiosity {

/// A system, symmetric and positive semi-definite, with a diagonal of about 1.
struct ResidualSystem {
  std::function<std::vector<double>(const std::vector<double>&)> multiply;
  std::function<double(const std::vector<double>&)> largest;  ///< size of a residual
  const StrongPairs& strong;                                  ///< the preconditioner
};

/// Solves until the residual is no larger than the tolerance, or further steps bring nothing
/// (Stiefel 1955). The method costs as much as conjugate gradients. Its residual falls in every
/// step, even if the system has no solution. Steps are added to `iterations`.
std::vector<double> conjugateResiduals(const ResidualSystem& system, std::vector<double> right,
                                       double tolerance, Progress& progress, int& iterations);

}  // namespace radiosity
