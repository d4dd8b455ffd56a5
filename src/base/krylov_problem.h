// A linear system for PETSc. The rows of its matrix lie in several processes.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace radiosity {

/// (I - L F R) z = b for all bands at once; L and R are diagonal. F is the sum of the processes'
/// parts; all other members are the same in all processes.
struct KrylovProblem {
  std::size_t rows = 0;
  int bands = 1;
  std::span<const double> left;        ///< L, rows * bands
  std::span<const double> right;       ///< R, likewise
  std::span<const double> right_side;  ///< b
  bool symmetric = false;              ///< L F R is symmetric, I - L F R positive definite
  /// Vectors, each rows * bands, that I - L F R nearly maps to 0 and whose supports are disjoint:
  /// the brightness of closed rooms. Place k belongs to vector near_null_of[k], with the value
  /// near_null[k]. Empty: there are none.
  std::span<const unsigned> near_null_of;
  std::span<const double> near_null;
  std::size_t near_nulls = 0;
  double reduction = 1e-10;  ///< of the residual in the 2-norm
  int most_products = 10000;
  /// y = this process's part of F x, and of the transpose of F times x; rows * bands each.
  std::function<void(std::span<const double> x, std::span<double> y)> product;
  std::function<void(std::span<const double> x, std::span<double> y)> transposed_product;
  /// Calls visit(i, j, F_ij) for this process's entries.
  using Visit = std::function<void(std::size_t row, std::size_t column, double value)>;
  std::function<void(const Visit& visit)> entries;
};

struct KrylovOutcome {
  int iterations = 0;
  std::vector<double> reductions;  ///< the residual's norm after each iteration, over the first
  bool indefinite = false;
  std::string solver;  ///< PETSc's words: "cg, shell"
};

}  // namespace radiosity
