// Gauss-Seidel: Jacobi's update row by row, each row using the new values of the rows before it
// (Cohen & Greenberg 1985; Cohen & Wallace 1993, section 5.3).
#include <algorithm>
#include <cmath>

#include "solve/iteration.h"

namespace radiosity {

namespace {

std::vector<double> diagonalOf(const ExchangeOperator& matrix) {
  std::vector<double> diagonal(matrix.size());
  for (std::size_t i = 0; i < diagonal.size(); ++i) diagonal[i] = matrix.at(i, i);
  return diagonal;
}

/// B_i <- (E_i + rho_i sum_{j != i} F_ij B_j) / (1 - rho_i F_ii) for one i after another: rows
/// depend on each other, so the sweep runs on one thread. Returns the largest change over max E,
/// worst band.
double sweepOnce(const System& system, const std::vector<double>& diagonal,
                 const Eigen::ArrayXd& largest_emission, Convergence& convergence,
                 std::vector<double>& radiosity) {
  const auto bands = std::size_t(system.bands);
  double largest_change = 0;
  const auto update = [&](std::size_t i, const double* gathered) {
    convergence.countRows(1);
    for (std::size_t b = 0; b < bands; ++b) {
      const std::size_t k = i * bands + b;
      const double rho = system.reflectance[k];
      const double from_others = gathered[b] - diagonal[i] * radiosity[k];
      const double updated = (system.emission[k] + rho * from_others) / (1 - rho * diagonal[i]);
      const double change = std::abs(updated - radiosity[k]) / largest_emission[Eigen::Index(b)];
      largest_change = std::max(largest_change, change);
      radiosity[k] = updated;
    }
  };
  system.matrix.sweep(radiosity, system.bands, update, system.reflecting);
  return largest_change;
}

}  // namespace

// After a sweep row i's residual is rho_i sum_{j > i} F_ij (change of B_j): where rows sum to at
// most 1 it is no larger than the largest change. So the product that measures the true residual is
// made only once the changes are within the tolerance, and it is the true residual that decides.
Fields gaussSeidel(const System& system, Convergence& convergence) {
  Fields fields{system.emission, std::vector<double>(system.emission.size())};
  const std::vector<double> diagonal = diagonalOf(system.matrix);
  const Eigen::ArrayXd largest = largestEmission(system);
  for (;;) {
    const bool last = convergence.lastSweep();
    const double change = sweepOnce(system, diagonal, largest, convergence, fields.radiosity);
    double residual = change;
    if (change <= convergence.tolerance() || last || Convergence::outOfBounds(change)) {
      system.matrix.product(fields.radiosity, system.bands, fields.irradiance, system.reflecting);
      residual = relativeResidual(system, fields.radiosity, fields.irradiance);
    }
    convergence.record(residual);
    if (convergence.finished()) return fields;
  }
}

}  // namespace radiosity
