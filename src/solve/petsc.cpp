// PETSc's solvers, where the rows of the matrix lie in several processes.
//
// With H = F B and z = L H, B = E + R z is the solution if (I - L F R) z = L F E. Where F is
// symmetric L = D sqrt(A) and R = D A^-1/2, D = sqrt(rho), as in conjugate_gradients.cpp; else L =
// rho and R = 1. PETSc stops by a norm of the residual of its recurrence. We then measure the true
// residual of B; if it is too large, PETSc solves for a correction of z.
#include <algorithm>
#include <utility>

#include "matrix/shared_rows.h"
#include "solve/iteration.h"

namespace radiosity {

namespace {

/// The share of the tolerance that PETSc is asked for: it stops by the 2-norm, but the tolerance is
/// for the largest residual.
constexpr double kMargin = 0.1;
constexpr double kLeastReduction = 1e-14;
/// The reduction that PETSc is asked for when only patches that little light reaches are not
/// settled.
constexpr double kSettling = 1e-3;

class PetscSolve {
 public:
  PetscSolve(const System& system, Convergence& convergence)
      : system_(system),
        convergence_(convergence),
        left_(system.reflectance),
        right_(left_.size(), 1.0),
        z_(left_.size(), 0.0),
        fields_{system.emission, std::vector<double>(left_.size())} {
    if (!system.matrix.isSymmetric()) return;
    symmetricScales(system, left_, right_);
  }

  Fields run() {
    Corrections corrections(system_, convergence_);
    for (;;) {
      for (std::size_t k = 0; k < z_.size(); ++k) {
        fields_.radiosity[k] = system_.emission[k] + right_[k] * z_[k];
      }
      if (corrections.end(fields_, indefinite_)) return std::move(fields_);
      improve(corrections.residual());
    }
  }

 private:
  /// Solves for a correction of z and adds it. `residual`: the relative residual of B.
  void improve(double residual) {
    if (rooms_.of_patch.empty() && system_.matrix.isSymmetric()) findRooms();
    std::vector<double> missing(z_.size());
    for (std::size_t k = 0; k < missing.size(); ++k) {
      missing[k] = left_[k] * fields_.irradiance[k] - z_[k];
    }
    KrylovProblem problem;
    problem.rows = system_.matrix.size();
    problem.bands = system_.bands;
    problem.left = left_;
    problem.right = right_;
    problem.right_side = missing;
    problem.symmetric = system_.matrix.isSymmetric();
    problem.near_null_of = room_of_;
    problem.near_null = problem.symmetric ? std::span<const double>(left_) : std::span<double>();
    problem.near_nulls = rooms_.count * std::size_t(system_.bands);
    const double wanted = kMargin * convergence_.tolerance() / residual;
    problem.reduction = wanted < kMargin ? std::max(wanted, kLeastReduction) : kSettling;
    problem.most_products = std::max(1, convergence_.sweepsLeft() - 1);  // one is left to check
    std::vector<double> step(z_.size());
    const KrylovOutcome outcome =
        dynamic_cast<const SharedRows&>(system_.matrix).solve(problem, step);
    indefinite_ = outcome.indefinite;
    for (const double reduced : outcome.reductions) {
      convergence_.countRows(system_.matrix.size());
      convergence_.record(residual * reduced, false);
    }
    if (indefinite_) return;
    for (std::size_t k = 0; k < z_.size(); ++k) z_[k] += step[k];
  }

  void findRooms() {
    rooms_ = system_.matrix.rooms();
    const auto bands = std::size_t(system_.bands);
    for (std::size_t k = 0; k < z_.size(); ++k) {
      room_of_.push_back(unsigned(rooms_.of_patch[k / bands] * bands + k % bands));
    }
  }

  const System& system_;
  Convergence& convergence_;
  std::vector<double> left_;
  std::vector<double> right_;
  std::vector<double> z_;
  Fields fields_;
  ExchangeOperator::Rooms rooms_;
  std::vector<unsigned> room_of_;  // by patch * bands + band: room * bands + band
  bool indefinite_ = false;
};

}  // namespace

Fields petscSolve(const System& system, Convergence& convergence) {
  return PetscSolve(system, convergence).run();
}

}  // namespace radiosity
