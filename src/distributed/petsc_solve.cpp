#include "distributed/petsc_solve.h"

#include <petscksp.h>

#include <optional>
#include <string_view>
#include <vector>

#include "distributed/shell_operator.h"
#include "radiosity/base.h"

namespace radiosity {

namespace {

/// Owns an object of PETSc and destroys it.
template <class Handle, PetscErrorCode (*destroy)(Handle*)>
struct Owned {
  Handle handle = nullptr;
  Owned() = default;
  ~Owned() { destroy(&handle); }
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;
};
using OwnedMat = Owned<Mat, MatDestroy>;
using OwnedVec = Owned<Vec, VecDestroy>;
using OwnedKsp = Owned<KSP, KSPDestroy>;

/// The preconditioner r + W (W^T A W)^-1 W^T r; W are the near null vectors. W^T A W is diagonal,
/// since A does not couple them. Their eigenvalues become near 1, like all others. (The additive
/// coarse correction of Nicolaides, SIAM J. Numer. Anal. 24, 1987.)
class CoarseCorrection {
 public:
  CoarseCorrection(const KrylovProblem& problem, const ShellOperator& shell)
      : problem_(problem), shell_(shell), inverse_(problem.near_nulls, 0.0) {
    OwnedVec w;
    OwnedVec image;
    requireNoError(MatCreateVecs(shell.matrix(), &w.handle, &image.handle));
    set(w.handle, std::vector<double>(problem.near_nulls, 1.0), INSERT_VALUES);
    requireNoError(MatMult(shell.matrix(), w.handle, image.handle));
    const std::vector<double> energy = shares(image.handle);
    const std::vector<double> whole = shares(w.handle);
    constexpr double kNothingLeft = 1e-13;
    for (std::size_t n = 0; n < inverse_.size(); ++n) {
      if (energy[n] > kNothingLeft * whole[n]) inverse_[n] = 1 / energy[n];
    }
  }

  static PetscErrorCode apply(PC pc, Vec r, Vec result) {
    CoarseCorrection* self = nullptr;
    PCShellGetContext(pc, &self);
    std::vector<double> c = self->shares(r);
    for (std::size_t n = 0; n < c.size(); ++n) c[n] *= self->inverse_[n];
    VecCopy(r, result);
    self->set(result, c, ADD_VALUES);
    return 0;
  }

  /// Gives the near null vectors to the matrix, for preconditioners that use them.
  void attach(Mat matrix) const {
    std::vector<Vec> vectors(problem_.near_nulls, nullptr);
    for (std::size_t n = 0; n < vectors.size(); ++n) {
      requireNoError(MatCreateVecs(matrix, &vectors[n], nullptr));
      std::vector<double> only(vectors.size(), 0.0);
      only[n] = 1;
      set(vectors[n], only, INSERT_VALUES);
      requireNoError(VecNormalize(vectors[n], nullptr));
    }
    MatNullSpace space = nullptr;
    requireNoError(MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, PetscInt(vectors.size()),
                                      vectors.data(), &space));
    requireNoError(MatSetNearNullSpace(matrix, space));
    MatNullSpaceDestroy(&space);
    for (Vec& vector : vectors) VecDestroy(&vector);
  }

 private:
  /// W^T v.
  std::vector<double> shares(Vec v) const {
    const double* values = nullptr;
    requireNoError(VecGetArrayRead(v, &values));
    std::vector<double> sums(problem_.near_nulls, 0.0);
    for (std::size_t k = 0; k < shell_.count(); ++k) {
      const std::size_t place = shell_.first() + k;
      sums[problem_.near_null_of[place]] += problem_.near_null[place] * values[k];
    }
    requireNoError(VecRestoreArrayRead(v, &values));
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), int(sums.size()), MPI_DOUBLE, MPI_SUM,
                  PETSC_COMM_WORLD);
    return sums;
  }

  /// v = W c or v += W c.
  void set(Vec v, const std::vector<double>& c, InsertMode mode) const {
    double* values = nullptr;
    requireNoError(VecGetArray(v, &values));
    for (std::size_t k = 0; k < shell_.count(); ++k) {
      const std::size_t place = shell_.first() + k;
      const double value = c[problem_.near_null_of[place]] * problem_.near_null[place];
      values[k] = mode == ADD_VALUES ? values[k] + value : value;
    }
    requireNoError(VecRestoreArray(v, &values));
  }

  const KrylovProblem& problem_;
  const ShellOperator& shell_;
  std::vector<double> inverse_;
};

bool wantsEntries() {
  char type[16] = "shell";
  requireNoError(
      PetscOptionsGetString(nullptr, nullptr, "-radiosity_mat_type", type, sizeof type, nullptr));
  const std::string_view wanted = type;
  if (wanted != "shell" && wanted != "aij") {
    throw RunError("-radiosity_mat_type " + std::string(wanted) + ": give shell or aij");
  }
  return wanted == "aij";
}

std::string nameOf(KSP ksp, PC pc) {
  KSPType solver = nullptr;
  PCType preconditioner = nullptr;
  requireNoError(KSPGetType(ksp, &solver));
  requireNoError(PCGetType(pc, &preconditioner));
  return std::string(solver) + ", " + preconditioner;
}

}  // namespace

KrylovOutcome petscSolve(const KrylovProblem& problem, std::span<double> solution) {
  ShellOperator shell(problem);
  std::optional<CoarseCorrection> coarse;
  if (problem.near_nulls > 0) coarse.emplace(problem, shell);
  OwnedMat entries;
  if (wantsEntries()) {
    entries.handle = shell.assembled();
    if (coarse) coarse->attach(entries.handle);
  }
  const Mat matrix = entries.handle != nullptr ? entries.handle : shell.matrix();

  OwnedKsp ksp;
  PC pc = nullptr;
  requireNoError(KSPCreate(PETSC_COMM_WORLD, &ksp.handle));
  requireNoError(KSPSetOperators(ksp.handle, matrix, matrix));
  requireNoError(KSPSetType(ksp.handle, problem.symmetric ? KSPCG : KSPGMRES));
  requireNoError(KSPSetNormType(ksp.handle, KSP_NORM_UNPRECONDITIONED));
  if (!problem.symmetric) requireNoError(KSPSetPCSide(ksp.handle, PC_RIGHT));
  requireNoError(KSPSetTolerances(ksp.handle, problem.reduction, PETSC_DEFAULT, PETSC_DEFAULT,
                                  problem.most_products));
  requireNoError(KSPSetResidualHistory(ksp.handle, nullptr, problem.most_products + 1, PETSC_TRUE));
  requireNoError(KSPGetPC(ksp.handle, &pc));
  requireNoError(PCSetType(pc, coarse ? PCSHELL : PCNONE));
  if (coarse) {
    requireNoError(PCShellSetContext(pc, &*coarse));
    requireNoError(PCShellSetApply(pc, CoarseCorrection::apply));
  }
  requireNoError(KSPSetFromOptions(ksp.handle));

  OwnedVec b;
  OwnedVec z;
  requireNoError(MatCreateVecs(matrix, &z.handle, &b.handle));
  double* values = nullptr;
  requireNoError(VecGetArray(b.handle, &values));
  const std::span<const double> right_side = shell.own(problem.right_side);
  std::copy(right_side.begin(), right_side.end(), values);
  requireNoError(VecRestoreArray(b.handle, &values));
  requireNoError(KSPSolve(ksp.handle, b.handle, z.handle));

  KrylovOutcome outcome;
  PetscInt iterations = 0;
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  const PetscReal* history = nullptr;
  PetscInt recorded = 0;
  requireNoError(KSPGetResidualHistory(ksp.handle, &history, &recorded));
  requireNoError(KSPGetIterationNumber(ksp.handle, &iterations));
  requireNoError(KSPGetConvergedReason(ksp.handle, &reason));
  outcome.iterations = int(iterations);
  for (PetscInt k = 1; k < recorded; ++k) {
    outcome.reductions.push_back(history[k] / history[0]);
  }
  outcome.indefinite = reason == KSP_DIVERGED_INDEFINITE_MAT ||
                       reason == KSP_DIVERGED_INDEFINITE_PC || reason == KSP_DIVERGED_NANORINF;
  outcome.solver = nameOf(ksp.handle, pc);
  shell.gather(z.handle, solution);
  return outcome;
}

}  // namespace radiosity
