#include "solve/certificate.h"

#include <cmath>
#include <limits>

namespace radiosity {

namespace {

/// Residual, over 1, at which a trial vector of the rough solve is good enough: w is then within
/// 10% of the best vector there is.
constexpr double kRoughTolerance = 0.1;

/// Bounds the relative rounding error of a row sum of n products of non-negative numbers, made in
/// four running sums, and of the few operations around it (Higham, "Accuracy and Stability of
/// Numerical Algorithms", 2002, section 3.1), with a factor 2 to spare.
double roundingUnit(std::size_t n) {
  return (double(n) / 4 + 16) * std::numeric_limits<double>::epsilon();
}

/// Let M = I - rho F, whose off-diagonal entries are <= 0. Any w > 0 with v = M w > 0 makes M a
/// non-singular M-matrix: inv(M) >= 0 (Berman & Plemmons, "Nonnegative Matrices in the Mathematical
/// Sciences", chapter 6). With B* - B = inv(M) r and |r| <= q v, q = max_k |r_k| / v_k,
///     |B* - B| <= inv(M) |r| <= q inv(M) v = q w.
/// Row sums may exceed 1. v is rounded down and |r| up by what rounding can have done to them.
std::optional<double> boundFrom(const System& system, const Fields& fields, const Fields& trial) {
  const double unit = roundingUnit(system.matrix.size());
  const auto rho = asArray(system.reflectance, system.bands);
  const auto emission = asArray(system.emission, system.bands);
  const auto b = asArray(fields.radiosity, system.bands);
  const auto w = asArray(trial.radiosity, system.bands);
  const BandArray reflected = rho * asArray(fields.irradiance, system.bands);
  const BandArray w_reflected = rho * asArray(trial.irradiance, system.bands);
  const BandArray v = (w - w_reflected) - unit * (w + w_reflected);
  if (!(w.minCoeff() > 0) || !(v.minCoeff() > 0)) return std::nullopt;
  const BandArray r =
      (emission + reflected - b).abs() + unit * (emission.abs() + reflected.abs() + b.abs());
  const double bound =
      ((r / v).colwise().maxCoeff() * w.colwise().maxCoeff()).maxCoeff() * (1 + unit);
  return std::isfinite(bound) ? std::optional(bound) : std::nullopt;
}

}  // namespace

// The all-ones vector costs one product and serves wherever every rho_i rowsum_i < 1. Otherwise w
// is a rough solution of M w = 1: if 1 - M w is within 0.1, then v = M w >= 0.9 > 0. The products
// with the first w and the last are worth a sweep each.
//
// Where some F_ij are below 0, |F| takes the place of F in M and v: I - rho F is an H-matrix, whose
// inverse is within that of its comparison matrix I - rho |F| (Ostrowski 1937). Of |F| the sums of
// rows are known.
std::optional<double> certifiedErrorBound(const System& system, const Fields& fields,
                                          int max_sweeps, Progress& progress) {
  const std::vector<double> ones(fields.radiosity.size(), 1.0);
  Fields trial{ones, ones};
  if (!system.matrix.isNonNegative()) {
    const std::vector<double> norms = system.matrix.rowNorms();
    for (std::size_t k = 0; k < trial.irradiance.size(); ++k) {
      trial.irradiance[k] = norms[k / std::size_t(system.bands)];
    }
    return boundFrom(system, fields, trial);
  }
  system.matrix.product(trial.radiosity, system.bands, trial.irradiance, system.reflecting);
  if (const auto bound = boundFrom(system, fields, trial)) return bound;
  if (max_sweeps < 3) return std::nullopt;
  Convergence convergence(kRoughTolerance, max_sweeps - 2, "bounding the error", progress);
  trial = krylovSolve(System(system.matrix, system.bands, system.reflectance, ones), convergence);
  return boundFrom(system, fields, trial);
}

}  // namespace radiosity
