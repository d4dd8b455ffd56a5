// Systems to solve whose answers are known, and a direct solver to compare with.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "radiosity/row_matrix.h"
#include "radiosity/solve.h"
#include "radiosity/symmetric_matrix.h"

namespace radiosity::test {

using Matrix = Eigen::MatrixXd;

/// The rest of a row to 1 goes to the sky, but for its share `on_backs`. Rows above 1 lose nothing.
inline void setAccounts(FormFactors& factors, double on_backs) {
  const std::size_t n = factors.matrix->size();
  factors.fronts = factors.matrix->rowSums();
  factors.sky.resize(n);
  factors.backs.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double lost = std::max(0.0, 1 - factors.fronts[i]);
    factors.backs[i] = on_backs * lost;
    factors.sky[i] = lost - factors.backs[i];
  }
}

/// Form factors with F = `dense`, row by row, and those accounts.
inline FormFactors factorsFrom(const Matrix& dense, std::vector<double> area, double on_backs = 0.0,
                               Precision precision = Precision::double_precision) {
  const auto n = std::size_t(dense.rows());
  const auto matrix = std::make_shared<RowMatrix>(std::move(area), precision);
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (std::size_t j = 0; j < n; ++j) {
      const double value = dense(Eigen::Index(i), Eigen::Index(j));
      if (value == 0) continue;
      columns.push_back(Index(j));
      values.push_back(value);
    }
    matrix->setRow(i, columns, values);
  }
  FormFactors factors;
  factors.matrix = matrix;
  setAccounts(factors, on_backs);
  return factors;
}

/// The same in the symmetric form, stored in a random order; A_i F_ij = A_j F_ji must hold. Values
/// are those of the half that is stored, rounded to `precision`.
inline FormFactors symmetricFactorsFrom(const Matrix& dense, std::vector<double> area,
                                        double on_backs = 0.0,
                                        Precision precision = Precision::double_precision) {
  const std::size_t n = area.size();
  std::vector<Index> order(n);
  for (std::size_t k = 0; k < n; ++k) order[k] = Index(k);
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  const auto matrix = std::make_shared<SymmetricMatrix>(std::move(area), order, precision);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> row;
    for (std::size_t q = k; q < n; ++q) row.push_back(dense(order[k], order[q]));
    matrix->setUpperRow(k, row);
  }
  FormFactors factors;
  factors.matrix = matrix;
  setAccounts(factors, on_backs);
  return factors;
}

/// The unit cube, one patch a face: floor, ceiling, four walls. Howell C-11 and C-14, to the digits
/// at which a row sums to 1 exactly.
inline Matrix cube() {
  const double opposite = 0.199824895698387;
  const double adjacent = (1 - opposite) / 4;  // 0.20004377607540
  Matrix f = Matrix::Constant(6, 6, adjacent);
  for (Eigen::Index i = 0; i < 6; ++i) {
    f(i, i) = 0;
    f(i, i ^ 1) = opposite;
  }
  return f;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  std::vector<double> vector(std::size_t n, double low, double high) {
    std::vector<double> values(n);
    for (double& value : values) value = (*this)(low, high);
    return values;
  }
  /// Non-negative, a third of it zero, irreducible, rows that sum to `row_sum(i)`; not symmetric.
  template <class RowSum>
  Matrix rows(Eigen::Index n, const RowSum& row_sum) {
    Matrix f(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) f(i, j) = std::max(0.0, (*this)(-0.5, 1.0));
      f(i, (i + 1) % n) += 0.1;
      f.row(i) *= row_sum(i) / f.row(i).sum();
    }
    return f;
  }

 private:
  std::mt19937 engine_;
};

/// inv(I - rho F) E band by band, by LU with partial pivoting in 64-bit mantissas.
inline std::vector<double> direct(const Matrix& f, const std::vector<double>& reflectance,
                                  const std::vector<double>& emission, int bands) {
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  const Eigen::Index n = f.rows();
  std::vector<double> radiosity(emission.size());
  for (int b = 0; b < bands; ++b) {
    Long m = Long::Identity(n, n);
    Long e(n, 1);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = std::size_t(i * bands + b);
      m.row(i) -= static_cast<long double>(reflectance[k]) * f.row(i).cast<long double>();
      e(i) = emission[k];
    }
    const Long solved = m.partialPivLu().solve(e);
    for (Eigen::Index i = 0; i < n; ++i) radiosity[std::size_t(i * bands + b)] = double(solved(i));
  }
  return radiosity;
}

/// A symmetric exchange matrix with rows of different sums, some of it lost on backs.
struct Reciprocal {
  Matrix f;
  std::vector<double> area;
};

inline Reciprocal reciprocal(std::size_t n, Random& random) {
  Reciprocal out{Matrix(n, n), random.vector(n, 0.5, 2.0)};
  const auto size = Eigen::Index(n);
  for (Eigen::Index i = 0; i < size; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) out.f(i, j) = out.f(j, i) = random(0.0, 1.0);
  }
  for (Eigen::Index i = 0; i < size; ++i) {
    out.f.row(i) /= out.area[std::size_t(i)];
  }
  out.f /= out.f.rowwise().sum().maxCoeff();
  return out;
}

inline double largestDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = a.size() == b.size() ? 0 : INFINITY;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    largest = std::max(largest, std::abs(a[k] - b[k]));
  }
  return largest;
}

inline SolveOptions options(Solver solver, double tolerance, int max_iterations = 10000) {
  SolveOptions options;
  options.solver = solver;
  options.tolerance = tolerance;
  options.max_iterations = max_iterations;
  return options;
}

/// Iterations for any matrix.
inline constexpr Solver kIterations[] = {Solver::jacobi, Solver::gauss_seidel, Solver::gmres};
/// All solvers for any matrix.
inline constexpr Solver kSolvers[] = {Solver::jacobi, Solver::gauss_seidel, Solver::gmres,
                                      Solver::direct};

/// These, and for a symmetric matrix conjugate gradients.
inline std::vector<Solver> solversOf(const FormFactors& factors) {
  std::vector<Solver> solvers(std::begin(kSolvers), std::end(kSolvers));
  if (factors.matrix->isSymmetric()) solvers.push_back(Solver::cg);
  return solvers;
}
inline std::vector<Solver> iterationsOf(const FormFactors& factors) {
  std::vector<Solver> solvers(std::begin(kIterations), std::end(kIterations));
  if (factors.matrix->isSymmetric()) solvers.push_back(Solver::cg);
  return solvers;
}

}  // namespace radiosity::test
