// The dense system, factored: exact to rounding, for few unknowns.
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <memory>

#include "solve/iteration.h"

namespace radiosity {

namespace {

/// A negative B beyond this share of the largest B is not rounding.
constexpr double kNegative = 1e-6;

using Dense = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// I - rho F of one band, over the patches that reflect and are lit. All other patches have B = E.
/// This leaves out white rooms without light, whose matrix has no inverse.
class Factored {
 public:
  Factored(const System& system, const Eigen::Ref<const Dense>& f, Eigen::Index band) {
    const auto rho = asArray(system.reflectance, system.bands).col(band);
    const Eigen::Array<bool, Eigen::Dynamic, 1> lit =
        reached(f, asArray(system.emission, system.bands).col(band) != 0);
    for (Eigen::Index i = 0; i < f.rows(); ++i) {
      const bool exchanges = system.matrix.area()[std::size_t(i)] > 0;
      if (rho[i] > 0 && lit[i] && exchanges) members_.push_back(i);
    }
    const auto n = Eigen::Index(members_.size());
    Eigen::MatrixXd m(n, n);
    if (system.matrix.isSymmetric()) {
      // D^-1 sqrt(A) (I - rho F) A^-1/2 D is symmetric: see conjugate_gradients.cpp.
      scale_.resize(n);
      for (Eigen::Index k = 0; k < n; ++k) {
        const double area = system.matrix.area()[std::size_t(at(k))];
        scale_[k] = std::sqrt(rho[at(k)] / area);
      }
      for (Eigen::Index k = 0; k < n; ++k) {
        for (Eigen::Index l = 0; l <= k; ++l) {
          const double area = system.matrix.area()[std::size_t(at(k))];
          m(k, l) = double(k == l) - scale_[k] * area * f(at(k), at(l)) * scale_[l];
        }
      }
      cholesky_ = std::make_unique<Eigen::LLT<Eigen::MatrixXd>>(m);  // reads the lower triangle
      solvable_ = cholesky_->info() == Eigen::Success;
      return;
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      for (Eigen::Index l = 0; l < n; ++l) {
        m(k, l) = double(k == l) - rho[at(k)] * f(at(k), at(l));
      }
    }
    lu_ = std::make_unique<Eigen::PartialPivLU<Eigen::MatrixXd>>(m);
  }

  /// False where I - rho F is not positive definite, so that no B >= E solves the system.
  bool solvable() const { return solvable_; }

  /// Adds to B the correction that solves the system for this residual.
  void improve(const Eigen::ArrayXd& residual,
               Eigen::Ref<Eigen::ArrayXd, 0, Eigen::InnerStride<>> radiosity) const {
    Eigen::VectorXd r(Eigen::Index(members_.size()));
    for (Eigen::Index k = 0; k < r.size(); ++k) r[k] = residual[at(k)];
    if (cholesky_) {
      r = (r.array() / scale_).matrix();
      r = cholesky_->solve(r);
      r = (r.array() * scale_).matrix();
    } else {
      r = lu_->solve(r);
    }
    for (Eigen::Index k = 0; k < r.size(); ++k) radiosity[at(k)] += r[k];
  }

 private:
  using Flags = Eigen::Array<bool, Eigen::Dynamic, 1>;

  Eigen::Index at(Eigen::Index k) const { return members_[std::size_t(k)]; }

  /// The patches of `from`, those that see one of them, and so on.
  static Flags reached(const Eigen::Ref<const Dense>& f, Flags from) {
    std::vector<Eigen::Index> next;
    for (Eigen::Index j = 0; j < from.size(); ++j) {
      if (from[j]) next.push_back(j);
    }
    while (!next.empty()) {
      const Eigen::Index j = next.back();
      next.pop_back();
      for (Eigen::Index i = 0; i < from.size(); ++i) {
        if (from[i] || f(i, j) == 0) continue;
        from[i] = true;
        next.push_back(i);
      }
    }
    return from;
  }

  std::vector<Eigen::Index> members_;
  Eigen::ArrayXd scale_;                                   // D A^-1/2
  std::unique_ptr<Eigen::LLT<Eigen::MatrixXd>> cholesky_;  // where the matrix is symmetric
  std::unique_ptr<Eigen::PartialPivLU<Eigen::MatrixXd>> lu_;
  bool solvable_ = true;
};

}  // namespace

// Iterative refinement: the first step solves the system, later steps remove the rounding error.
Fields direct(const System& system, Convergence& convergence) {
  Fields fields{system.emission, std::vector<double>(system.emission.size())};
  auto radiosity = asArray(fields.radiosity, system.bands);
  const auto irradiance = asArray(fields.irradiance, system.bands);
  const auto emission = asArray(system.emission, system.bands);
  const auto reflectance = asArray(system.reflectance, system.bands);
  std::vector<Factored> factored;
  double last = HUGE_VAL;
  for (;;) {
    const double residual = measure(system, fields, convergence);
    if (convergence.finished()) return fields;
    if (!factored.empty() && residual > 0.5 * last) convergence.giveUp(GaveUp::rounding);
    last = residual;
    if (factored.empty()) {
      const std::vector<double> values = system.matrix.dense();
      const auto n = Eigen::Index(system.matrix.size());
      const Eigen::Map<const Dense> f(values.data(), n, n);
      for (Eigen::Index b = 0; b < system.bands; ++b) {
        convergence.check();
        factored.emplace_back(system, f, b);
        if (!factored.back().solvable()) convergence.giveUp(GaveUp::grows);
      }
    }
    if (convergence.gaveUp() != GaveUp::no) return fields;
    for (Eigen::Index b = 0; b < system.bands; ++b) {
      const Eigen::ArrayXd r =
          emission.col(b) + reflectance.col(b) * irradiance.col(b) - radiosity.col(b);
      factored[std::size_t(b)].improve(r, radiosity.col(b));
    }
    if (!system.nonnegative) continue;
    // If I - rho F has an inverse with negative entries, light grows without bounds.
    if (radiosity.minCoeff() < -kNegative * radiosity.maxCoeff()) {
      convergence.giveUp(GaveUp::grows);
      radiosity = emission;
    }
    radiosity = radiosity.max(emission);
  }
}

}  // namespace radiosity
