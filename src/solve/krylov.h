// Speeds up a linear iteration that converges slowly, as with bright walls or with rooms that
// hardly exchange light.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace radiosity {

/// GMRES (Saad & Schultz, SIAM J. Sci. Stat. Comput. 7, 1986) for one band of an affine iteration x
/// <- L x + c. It solves (I - L) d = s with s = L x + c - x; d is the error of x. Of all
/// combinations of s, L s, L L s, ... it takes the one that leaves least of s. An error in k
/// directions, such as one brightness for each of k rooms, is gone after k steps. The caller
/// applies L; the result does not depend on the number of threads.
class Krylov {
 public:
  explicit Krylov(const Eigen::VectorXd& step);

  /// The vector to which L is to be applied next; 0 once d is known to rounding.
  const Eigen::VectorXd& direction() const { return basis_.back(); }
  /// L times direction().
  void add(const Eigen::VectorXd& image);
  /// The rest of s.
  Eigen::VectorXd residual() const;
  bool exhausted() const { return exhausted_; }
  /// The d found so far.
  Eigen::VectorXd correction() const;

 private:
  Eigen::VectorXd leastSquares() const;

  double norm_ = 0;                       // of s
  std::vector<Eigen::VectorXd> basis_;    // orthonormal; one more than columns, unless exhausted
  std::vector<Eigen::VectorXd> columns_;  // of the Hessenberg matrix, column k with k + 2 values
  bool exhausted_ = false;
};

}  // namespace radiosity
