// Gauss-Seidel: the same update row by row, each row using the new values of the rows before it
// (Cohen & Greenberg 1985; Cohen & Wallace 1993, section 5.3). Sweeps are combined: by
// themselves they take 6,905 to 1e-6 in a closed room of reflectance 0.999, combined about a dozen.
#include <algorithm>
#include <cmath>
#include <utility>

#include "solve/iteration.h"
#include "solve/krylov.h"

namespace radiosity {

namespace {

class Sweeps {
 public:
  Sweeps(const System& system, Convergence& convergence)
      : system_(system), convergence_(convergence), diagonal_(system.matrix.size()) {
    for (std::size_t i = 0; i < diagonal_.size(); ++i) diagonal_[i] = system.matrix.at(i, i);
    largest_emission_ = asArray(system.emission, system.bands).colwise().maxCoeff();
  }

  /// B_i <- (c_i + rho_i sum_{j != i} F_ij B_j) / (1 - rho_i F_ii) for one i after another: rows
  /// depend on each other, so the sweep runs on one thread. Returns the largest change over max E,
  /// worst band.
  double run(const std::vector<double>& constant, std::vector<double>& radiosity) {
    const auto bands = std::size_t(system_.bands);
    double largest_change = 0;
    const auto update = [&](std::size_t i, const double* gathered) {
      convergence_.countRows(1);
      for (std::size_t b = 0; b < bands; ++b) {
        const std::size_t k = i * bands + b;
        const double rho = system_.reflectance[k];
        const double from_others = gathered[b] - diagonal_[i] * radiosity[k];
        const double updated = (constant[k] + rho * from_others) / (1 - rho * diagonal_[i]);
        largest_change =
            std::max(largest_change, std::abs(updated - radiosity[k]) / largestEmission(b));
        radiosity[k] = updated;
      }
    };
    system_.matrix.sweep(radiosity, system_.bands, update, system_.reflecting);
    return largest_change;
  }

  double largestEmission(std::size_t band) const { return largest_emission_[Eigen::Index(band)]; }

 private:
  const System& system_;
  Convergence& convergence_;
  std::vector<double> diagonal_;
  Eigen::ArrayXd largest_emission_;
};

/// Combines sweeps, each band by itself, as long as that helps.
class Acceleration {
 public:
  Acceleration(const System& system, Sweeps& sweeps, Convergence& convergence)
      : system_(system), sweeps_(sweeps), convergence_(convergence) {}

  /// A sweep that changed `before` into `after` by at most `change` over max E. Replaces `after` by
  /// what to sweep next.
  void apply(const std::vector<double>& before, std::vector<double>& after, double change) {
    if (!helps(change)) return;
    std::vector<Krylov> bands;
    const auto x = asArray(before, system_.bands);
    auto next = asArray(after, system_.bands);
    for (Eigen::Index b = 0; b < next.cols(); ++b) {
      bands.emplace_back(Eigen::VectorXd(next.col(b) - x.col(b)));
    }
    run(bands);
    const auto emission = asArray(system_.emission, system_.bands);
    for (Eigen::Index b = 0; b < next.cols(); ++b) {
      // B is at least E, so this takes nothing away from B; and a sweep of it is at least E again.
      next.col(b) = (x.col(b) + bands[std::size_t(b)].correction().array()).max(emission.col(b));
    }
  }

 private:
  /// Memory for so many vectors a band; rooms of up to two dozen nearly separate parts need fewer.
  static constexpr int kMostSteps = 30;

  /// Not where plain sweeps are quick. False for good once two rounds have not halved the change:
  /// there is no B >= E then, since rho F has a spectral radius above 1, and plain sweeps grow and
  /// show it; or rounding is all there is.
  bool helps(double change) {
    const double last = std::exchange(last_change_, change);
    if (change <= 0.1 * last) return false;  // the first sweep too
    if (combined_ && change > 0.5 * last) ++failures_;
    combined_ = failures_ < 2;
    return combined_;
  }

  /// Runs until the residual is within the tolerance. One sweep is left for the result.
  void run(std::vector<Krylov>& bands) {
    const std::vector<double> nothing(system_.emission.size(), 0.0);
    std::vector<double> image(system_.emission.size());
    auto columns = asArray(image, system_.bands);
    for (int step = 0; step < kMostSteps && !convergence_.lastSweep(); ++step) {
      if (std::all_of(bands.begin(), bands.end(), [](const auto& b) { return b.exhausted(); })) {
        return;
      }
      for (std::size_t b = 0; b < bands.size(); ++b) {
        columns.col(Eigen::Index(b)) = bands[b].direction().array();
      }
      sweeps_.run(nothing, image);
      double left = 0;
      for (std::size_t b = 0; b < bands.size(); ++b) {
        bands[b].add(columns.col(Eigen::Index(b)).matrix());
        left = std::max(left, bands[b].residual() / sweeps_.largestEmission(b));
      }
      convergence_.record(left);
      if (left <= 0.5 * convergence_.tolerance()) return;
    }
  }

  const System& system_;
  Sweeps& sweeps_;
  Convergence& convergence_;
  double last_change_ = HUGE_VAL;
  bool combined_ = false;
  int failures_ = 0;
};

}  // namespace

// After a sweep row i's residual is rho_i sum_{j > i} F_ij (change of B_j): where rows sum to at
// most 1 it is no larger than the largest change. So the product that measures the true residual is
// made only once the changes are within the tolerance, and it is the true residual that decides.
// The result is always that of a sweep, never a combination.
Fields gaussSeidel(const System& system, Convergence& convergence) {
  Fields fields{system.emission, std::vector<double>(system.emission.size())};
  Sweeps sweeps(system, convergence);
  Acceleration acceleration(system, sweeps, convergence);
  for (;;) {
    const std::vector<double> before = fields.radiosity;
    const bool last = convergence.lastSweep();
    const double change = sweeps.run(system.emission, fields.radiosity);
    double residual = change;
    if (change <= convergence.tolerance() || last || Convergence::outOfBounds(change)) {
      system.matrix.product(fields.radiosity, system.bands, fields.irradiance, system.reflecting);
      residual = relativeResidual(system, fields.radiosity, fields.irradiance);
    }
    convergence.record(residual);
    if (convergence.finished()) return fields;
    acceleration.apply(before, fields.radiosity, change);
  }
}

}  // namespace radiosity
