// I - L F R as a PETSc matrix whose rows stay where they are.
#pragma once

#include <petscmat.h>

#include <cstddef>
#include <span>
#include <vector>

#include "base/krylov_problem.h"

namespace radiosity {

/// Throws RunError with PETSc's words if `code` is not 0.
void requireNoError(PetscErrorCode code);

/// Vectors are cut into one range of rows for each process, all bands of a row together. A product
/// gathers x in all processes (rows * bands numbers each), multiplies it by the rows of each, and
/// adds up the parts of y, each range in the process that owns it.
class ShellOperator {
 public:
  /// Keeps `problem` by reference.
  explicit ShellOperator(const KrylovProblem& problem);
  ~ShellOperator();
  ShellOperator(const ShellOperator&) = delete;
  ShellOperator& operator=(const ShellOperator&) = delete;

  Mat matrix() const { return matrix_; }
  /// The range of this process among the rows * bands places: its first place and its length.
  std::size_t first() const { return std::size_t(starts_[std::size_t(rank_)]); }
  std::size_t count() const { return std::size_t(counts_[std::size_t(rank_)]); }
  /// This process's range of an array of all places.
  std::span<const double> own(std::span<const double> all) const {
    return all.subspan(first(), count());
  }
  /// Gathers a whole vector in process 0; `all` is empty in the others.
  void gather(Vec vector, std::span<double> all) const;

  /// The same matrix with its entries (MATMPIAIJ), to be destroyed by the caller.
  Mat assembled() const;

 private:
  static PetscErrorCode multiply(Mat matrix, Vec x, Vec y);
  static PetscErrorCode multiplyTransposed(Mat matrix, Vec x, Vec y);
  static PetscErrorCode diagonal(Mat matrix, Vec diagonal);
  void apply(Vec x, Vec y, bool transposed);
  std::vector<double> sharedSums(std::vector<double>& parts) const;

  const KrylovProblem& problem_;
  int rank_ = 0;
  std::vector<int> counts_;
  std::vector<int> starts_;
  std::vector<double> x_;  // rows * bands
  std::vector<double> y_;
  Mat matrix_ = nullptr;
};

}  // namespace radiosity
