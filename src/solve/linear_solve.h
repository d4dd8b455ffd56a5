// Runs a solver on a system, then bounds the error.
#pragma once

#include "radiosity/exchange_operator.h"
#include "radiosity/solve.h"
#include "solve/iteration.h"

namespace radiosity {

/// Errors: InputError if `solver` cannot solve with this matrix.
void requireSolver(Solver solver, const ExchangeOperator& matrix);

/// Solves by options.solver, then bounds the error. Fills in the summary but for energy, skips and
/// time.
Fields solveSystem(const System& system, const SolveOptions& options, Progress& progress,
                   SolveSummary& summary);

}  // namespace radiosity
