// Solves B = E + rho F B for callers that have reflectances and a right-hand side, but no scene.
#pragma once

#include <span>
#include <vector>

#include "radiosity/exchange_matrix.h"
#include "radiosity/solve.h"
#include "solve/iteration.h"

namespace radiosity {

/// Errors: InputError if `solver` cannot solve with this matrix.
void requireSolver(Solver solver, const ExchangeMatrix& matrix);

/// Solves by options.solver, then bounds the error. Fills in the summary but for energy, skips and
/// time.
Fields solveSystem(const System& system, const SolveOptions& options, Progress& progress,
                   SolveSummary& summary);

/// B and H = F B, N * bands, row-major, and their summary, without energy, skips and time.
struct LinearSolution {
  std::vector<double> radiosity;
  std::vector<double> irradiance;
  SolveSummary summary;
};

/// Solves (I - rho F) B = `source` in every band, by options.solver. `reflectance`: N * bands,
/// row-major, 0 to 1; 1 is fine in a room that loses light elsewhere. `source`: likewise, finite,
/// of any sign. A band without a source has B = 0. If a room neither absorbs its light nor lets it
/// out, there is no solution: status no_convergence. Errors: InputError if options.solver cannot
/// solve with this matrix; Cancelled.
LinearSolution solveLinear(const ExchangeMatrix& matrix, std::span<const double> reflectance,
                           std::span<const double> source, int bands, const SolveOptions& options,
                           Progress& progress);

}  // namespace radiosity
