// A linear system whose matrix lies in rows on several processes, for PETSc.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace radiosity {

/// (I - L F R) z = b for all bands at once, L and R diagonal. F is the sum of what the processes
/// hold; all else is the same in all of them.
struct KrylovProblem {
  std::size_t rows = 0;
  int bands = 1;
  std::span<const double> left;        ///< L, rows * bands
  std::span<const double> right;       ///< R, likewise
  std::span<const double> right_side;  ///< b
  bool symmetric = false;              ///< L F R is, and I less it is positive definite
  /// Vectors, each rows * bands, that I - L F R nearly maps to 0 and that have no place in common:
  /// the brightness of closed rooms. Place k belongs to number near_null_of[k]; empty: there are
  /// none. Its values are near_null[k].
  std::span<const unsigned> near_null_of;
  std::span<const double> near_null;
  std::size_t near_nulls = 0;
  double reduction = 1e-10;  ///< of the residual in the 2-norm
  int most_products = 10000;
  /// Of x, rows * bands: this process's part of F x, and of its transpose.
  std::function<void(std::span<const double> x, std::span<double> y)> product;
  std::function<void(std::span<const double> x, std::span<double> y)> transposed_product;
  /// Calls visit(i, j, F_ij) for this process's entries.
  using Visit = std::function<void(std::size_t row, std::size_t column, double value)>;
  std::function<void(const Visit& visit)> entries;
};

struct KrylovOutcome {
  int iterations = 0;
  std::vector<double> reductions;  ///< of the residual's norm after each, against the first
  bool indefinite = false;
  std::string solver;  ///< PETSc's words: "cg, shell"
};

}  // namespace radiosity
