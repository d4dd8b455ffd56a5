#include "solve/linear_solve.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

#include "matrix/shared_rows.h"
#include "radiosity/spelling.h"
#include "solve/certificate.h"

namespace radiosity {

namespace {

/// The words for a solver's iterations in messages: "12 products of conjugate gradients".
std::string_view workOf(Solver solver) {
  switch (solver) {
    case Solver::automatic:
      break;
    case Solver::jacobi:
      return "Jacobi sweeps";
    case Solver::gauss_seidel:
      return "Gauss-Seidel sweeps";
    case Solver::cg:
      return "products of conjugate gradients";
    case Solver::gmres:
      return "products of GMRES";
    case Solver::direct:
      return "products of the direct solver";
    case Solver::petsc:
      return "products of PETSc";
  }
  throw std::logic_error("a solver without a name");
}

Fields run(Solver solver, const System& system, Convergence& convergence) {
  switch (solver) {
    case Solver::automatic:
      break;
    case Solver::jacobi:
      return jacobi(system, convergence);
    case Solver::gauss_seidel:
      return gaussSeidel(system, convergence);
    case Solver::cg:
      return conjugateGradients(system, convergence);
    case Solver::gmres:
      return gmres(system, convergence);
    case Solver::direct:
      return direct(system, convergence);
    case Solver::petsc:
      return petscSolve(system, convergence);
  }
  throw std::logic_error("a solver without an iteration");
}

bool isShared(const ExchangeOperator& matrix) {
  return dynamic_cast<const SharedRows*>(&matrix) != nullptr;
}

struct Choice {
  Solver solver = Solver::automatic;
  std::string why;  ///< empty: it was asked for
};

Choice choose(Solver asked, const ExchangeOperator& matrix) {
  if (asked != Solver::automatic) return {asked, ""};
  if (matrix.size() <= kFewUnknowns) return {Solver::direct, "few unknowns"};
  if (isShared(matrix)) return {Solver::petsc, "the rows lie in several processes"};
  if (matrix.isSymmetric()) return {Solver::cg, "the matrix is symmetric"};
  return {Solver::gmres, "the matrix is not symmetric"};
}

std::string_view cureOf(GaveUp why, bool dark_left) {
  switch (why) {
    case GaveUp::grows:
      return "it grows: reflectance times row sum is above 1 over much of a room, so restore "
             "closure or use the raw rows";
    case GaveUp::rounding:
      return "rounding keeps it from coming closer: ask for less";
    case GaveUp::no:
      break;
  }
  return dark_left ? "patches that little light reaches are not settled yet: allow more"
                   : "reflectances near 1 in a closed room need many sweeps: allow more, or use "
                     "the solver auto";
}

std::string convergenceMessage(const SolveSummary& summary, const Choice& choice, double tolerance,
                               std::string_view cure) {
  const std::string why = choice.why.empty() ? "" : fmt::format(" (auto: {})", choice.why);
  const std::string numbers =
      fmt::format("{} {}{}, residual {:.2e} (asked for {:.2e})", summary.iterations,
                  workOf(choice.solver), why, summary.residual, tolerance);
  const std::string bound =
      summary.error_bound
          ? fmt::format("the error against this matrix's solution is below {:.2e} W/m^2",
                        *summary.error_bound)
          : std::string(
                "no certificate: the error could not be bounded in the time that the "
                "solution took");
  if (summary.status == SolveStatus::converged) {
    return fmt::format("converged: {}; {}; usable", numbers, bound);
  }
  return fmt::format("no convergence: {}; {}; not usable as it is; {}", numbers, bound, cure);
}

/// The certificate may take as many sweeps as the solution, and this many more after a direct
/// solution: factoring costs more than the few products that the direct solver counts.
constexpr int kFactoringSweeps = 16;

}  // namespace

Fields solveSystem(const System& system, const SolveOptions& options, Progress& progress,
                   SolveSummary& summary) {
  const Choice choice = choose(options.solver, system.matrix);
  summary.solver = choice.solver;
  Fields fields;
  std::string_view cure;
  GaveUp gave_up = GaveUp::no;
  {
    Convergence convergence(options.tolerance, options.max_iterations, "solving", progress);
    fields = run(choice.solver, system, convergence);
    gave_up = convergence.gaveUp();
    cure = cureOf(gave_up, convergence.darkLeft());
    summary.status = convergence.converged() ? SolveStatus::converged : SolveStatus::no_convergence;
    summary.iterations = convergence.sweeps();
    summary.rows = convergence.rows();
    summary.residual_history = convergence.history();
  }
  summary.residual = summary.residual_history.back();
  if (gave_up != GaveUp::grows) {
    const int factoring = choice.solver == Solver::direct ? kFactoringSweeps : 0;
    summary.error_bound =
        certifiedErrorBound(system, fields, summary.iterations + factoring, progress);
  }
  summary.message = convergenceMessage(summary, choice, options.tolerance, cure);
  blackIrradiance(system, fields);
  return fields;
}

void requireSolver(Solver solver, const ExchangeOperator& matrix) {
  if (solver == Solver::cg && !matrix.isSymmetric()) {
    throw InputError(fmt::format(
        "solver cg: conjugate gradients need a symmetric matrix, and rows of hemicubes are not "
        "(A_i F_ij = A_j F_ji does not hold); use gmres or auto, or merge the rows ({})",
        spelled("symmetrize")));
  }
  if (solver == Solver::petsc && !isShared(matrix)) {
    throw InputError(
        "solver petsc: it runs on pairs that the processes of mpirun share: mpirun -n 4 radiosity "
        "solve ...; without, or for rows that are cut, use auto");
  }
  if (solver == Solver::gauss_seidel && !matrix.sweeps()) {
    throw InputError(
        "solver gauss-seidel: a row after the other needs all rows, as they are stored, in one "
        "process; use cg or auto, or under mpirun petsc");
  }
  if (solver == Solver::direct && matrix.size() > kMostDirectUnknowns) {
    throw InputError(fmt::format(
        "solver direct: {} unknowns are too many for a dense matrix, {} are the most; use auto",
        matrix.size(), kMostDirectUnknowns));
  }
}

}  // namespace radiosity
