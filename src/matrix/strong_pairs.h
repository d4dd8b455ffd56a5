// Direct solution of strongly coupled pairs of rows, at which an iteration converges slowly.
#pragma once

#include <Eigen/SparseCholesky>
#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A preconditioner of symmetric systems whose diagonal is about 1 and no smaller than the sum of
/// the row's other values. If most of a row's weight is with one partner, as for two patches close
/// together, the residual oscillates between the two: the system is nearly singular there, and such
/// pairs take most of the steps. They are few. So we factorise the diagonal and the values of at
/// least kStrong (sparse, LDL^T) and leave the rest to the iteration.
class StrongPairs {
 public:
  /// The least strong value; a lower one would save a few more steps.
  static constexpr double kStrong = 0.1;

  struct Pair {
    Index row;
    Index later;
    double value;
  };
  StrongPairs(std::span<const double> diagonal, std::span<const Pair> pairs);

  std::vector<double> solve(const std::vector<double>& x) const;

 private:
  using Matrix = Eigen::SparseMatrix<double>;
  Eigen::SimplicialLDLT<Matrix> solver_;
};

}  // namespace radiosity
