// Pairs of rows that an iteration would not get apart, solved directly.
#pragma once

#include <Eigen/SparseCholesky>
#include <cstddef>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A preconditioner of symmetric systems whose diagonal is about 1 and no smaller than the sum of
/// the row's other values. Where a row's weight is mostly one partner's, as of two patches close
/// together, what the two lack goes to and fro between them: the system is nearly singular there,
/// and such pairs are what takes most steps. They are few: the diagonal and the values of at least
/// kStrong are factorised (sparse, LDL^T), the rest is left to the iteration.
class StrongPairs {
 public:
  /// A value is strong from here on; a lower bound would save a few steps more.
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
