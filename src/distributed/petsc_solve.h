// PETSc's solvers on a matrix whose rows are spread over all processes.
#pragma once

#include <span>

#include "base/krylov_problem.h"

namespace radiosity {

/// Solves with PETSc's KSP; all processes must call it. PETSc's options choose the solver
/// (-ksp_type, -pc_type, -ksp_monitor, ...). The default is conjugate gradients, or GMRES for a
/// matrix that is not symmetric. The operator is a shell over the rows; -radiosity_mat_type aij
/// assembles it as a MATMPIAIJ, for preconditioners that need entries (sor, gamg): 12 bytes an
/// entry and band. `solution`: rows * bands in process 0, else empty. Errors: RunError with PETSc's
/// words.
KrylovOutcome petscSolve(const KrylovProblem& problem, std::span<double> solution);

}  // namespace radiosity
