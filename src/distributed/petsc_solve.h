// PETSc's solvers on a matrix that lies in rows on all processes.
#pragma once

#include <span>

#include "base/krylov_problem.h"

namespace radiosity {

/// By all processes. KSP as PETSc's options say (-ksp_type, -pc_type, -ksp_monitor, ...), where
/// they say nothing conjugate gradients or, of a matrix that is not symmetric, GMRES. The operator
/// is a shell over the rows; -radiosity_mat_type aij assembles a MATMPIAIJ of it, for
/// preconditioners that look at entries (sor, gamg): 12 bytes an entry and band.
/// `solution`: rows * bands in process 0, else empty. RunError with PETSc's words where it fails.
KrylovOutcome petscSolve(const KrylovProblem& problem, std::span<double> solution);

}  // namespace radiosity
