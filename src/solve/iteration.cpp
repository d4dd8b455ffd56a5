#include "solve/iteration.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace radiosity {

namespace {

constexpr double kProgressSteps = 100;

/// After this many corrections in a row that each leave more than half of the residual, the rest is
/// taken for rounding.
constexpr int kMostStalls = 3;

/// |r| never grows where rho_i rowsum_i <= 1; row sums a little above 1 may let it grow a little
/// before it falls. A residual of a million times the emission is beyond both.
constexpr double kDivergedResidual = 1e6;

}  // namespace

System::System(const ExchangeOperator& f, int count, std::vector<double> rho, std::vector<double> e)
    : matrix(f), bands(count), reflectance(std::move(rho)), emission(std::move(e)) {
  nonnegative = matrix.isNonNegative() && std::all_of(emission.begin(), emission.end(),
                                                      [](double value) { return value >= 0; });
  const auto width = std::size_t(bands);
  if (width == 0) return;
  reflecting.resize(matrix.size());
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    const double* own = reflectance.data() + i * width;
    const bool reflects = std::any_of(own, own + width, [](double r) { return r > 0; });
    reflecting[i] = reflects ? 1 : 0;
    black += reflects ? 0 : 1;
  }
  if (black == 0) reflecting.clear();
}

void blackIrradiance(const System& system, Fields& fields) {
  if (system.black == 0) return;
  std::vector<std::uint8_t> wanted = system.reflecting;
  for (std::uint8_t& flag : wanted) flag = flag == 0 ? 1 : 0;
  system.matrix.product(fields.radiosity, system.bands, fields.irradiance, wanted);
}

void multiply(const System& system, Fields& fields, Convergence& convergence) {
  system.matrix.product(fields.radiosity, system.bands, fields.irradiance, system.reflecting);
  convergence.countRows(system.matrix.size() - system.black);
}

Fields krylovSolve(const System& system, Convergence& convergence) {
  return system.matrix.isSymmetric() ? conjugateGradients(system, convergence)
                                     : gmres(system, convergence);
}

Eigen::ArrayXd largestEmission(const System& system) {
  return asArray(system.emission, system.bands).abs().colwise().maxCoeff();
}

double relativeResidual(const System& system, const std::vector<double>& radiosity,
                        const std::vector<double>& irradiance) {
  const auto emission = asArray(system.emission, system.bands);
  const auto residual =
      emission + asArray(system.reflectance, system.bands) * asArray(irradiance, system.bands) -
      asArray(radiosity, system.bands);
  return (residual.abs().colwise().maxCoeff() / emission.abs().colwise().maxCoeff()).maxCoeff();
}

bool smallEverywhere(const System& system, const std::vector<double>& radiosity,
                     const std::vector<double>& irradiance, double tolerance) {
  if (!system.nonnegative) return true;
  const Eigen::ArrayXd rounding = kOwnRounding * largestEmission(system);
  for (std::size_t k = 0; k < radiosity.size(); ++k) {
    const double own = system.emission[k] + system.reflectance[k] * irradiance[k];
    const double most = kOwnShare * tolerance * own + rounding[Eigen::Index(k) % system.bands];
    if (!(std::abs(own - radiosity[k]) <= most)) return false;
  }
  return true;
}

double measure(const System& system, Fields& fields, Convergence& convergence) {
  multiply(system, fields, convergence);
  const double residual = relativeResidual(system, fields.radiosity, fields.irradiance);
  convergence.record(residual, smallEverywhere(system, fields.radiosity, fields.irradiance,
                                               convergence.tolerance()));
  return residual;
}

bool Corrections::end(Fields& fields, bool indefinite) {
  const double last = residual_;
  residual_ = measure(system_, fields, convergence_);
  stalls_ = residual_ > 0.5 * last ? stalls_ + 1 : 0;
  if (convergence_.converged()) return true;
  if (indefinite) convergence_.giveUp(GaveUp::grows);
  if (stalls_ == kMostStalls) convergence_.giveUp(GaveUp::rounding);
  return convergence_.finished();
}

void symmetricScales(const System& system, std::span<double> up, std::span<double> down) {
  const auto bands = std::size_t(system.bands);
  for (std::size_t k = 0; k < up.size(); ++k) {
    const double root = std::sqrt(system.matrix.area()[k / bands]);
    const double d = root > 0 ? std::sqrt(system.reflectance[k]) : 0.0;
    up[k] = d * root;
    down[k] = root > 0 ? d / root : 0.0;
  }
}

Convergence::Convergence(double tolerance, int max_sweeps, const std::string& stage,
                         Progress& progress)
    : tolerance_(tolerance), max_sweeps_(max_sweeps), progress_(progress) {
  progress_.begin(stage, std::size_t(kProgressSteps));
}

Convergence::~Convergence() { progress_.end(); }

void Convergence::record(double residual, bool everywhere) {
  history_.push_back(residual);
  everywhere_ = everywhere;
  const double way = residual > 0 ? std::log(residual) / std::log(tolerance_) : 1.0;
  const auto steps = std::max(reported_, std::size_t(kProgressSteps * std::clamp(way, 0.0, 1.0)));
  progress_.advance(steps - std::exchange(reported_, steps));
  progress_.check();
}

GaveUp Convergence::gaveUp() const {
  if (!history_.empty() && outOfBounds(history_.back())) return GaveUp::grows;
  return gave_up_;
}

bool Convergence::outOfBounds(double residual) {
  return !(residual <= kDivergedResidual);  // true for a NaN
}

}  // namespace radiosity
