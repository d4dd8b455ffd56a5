// GMRES on (I - rho F) B = E, for matrices that are not symmetric, such as the rows that hemicubes
// see: every step is one product, for all bands, on all threads.
#include <algorithm>
#include <cmath>

#include "solve/iteration.h"
#include "solve/krylov.h"

namespace radiosity {

namespace {

/// The most vectors kept a band; rooms of up to two dozen nearly separate parts need fewer.
constexpr int kMostSteps = 30;
/// A cycle ends once it has reduced its residual by this factor: beyond, rounding makes the
/// recurrence untrue.
constexpr double kTrueReduction = 1e-10;

class Gmres {
 public:
  Gmres(const System& system, Convergence& convergence)
      : system_(system),
        convergence_(convergence),
        largest_(largestEmission(system)),
        fields_{system.emission, std::vector<double>(system.emission.size())} {}

  Fields run() {
    const auto emission = asArray(system_.emission, system_.bands);
    const auto reflectance = asArray(system_.reflectance, system_.bands);
    auto radiosity = asArray(fields_.radiosity, system_.bands);
    const auto irradiance = asArray(fields_.irradiance, system_.bands);
    double last = HUGE_VAL;
    int failures = 0;
    for (;;) {
      const double residual = measure(system_, fields_, convergence_);
      if (convergence_.finished()) return std::move(fields_);
      const BandArray step = emission + reflectance * irradiance - radiosity;
      // Twice no gain: there is no B >= E, since rho F has a spectral radius above 1, and plain
      // sweeps grow and show it; or rounding is all there is.
      if (residual > 0.5 * last) ++failures;
      last = residual;
      if (failures < 2) {
        improve(step);
      } else {
        radiosity += step;
      }
    }
  }

 private:
  /// One cycle: corrects B for the residual `step`. Leaves one product to check the true residual.
  void improve(const BandArray& step) {
    const auto bands = std::size_t(system_.bands);
    std::vector<Krylov> krylov;
    for (std::size_t b = 0; b < bands; ++b) {
      krylov.emplace_back(Eigen::VectorXd(step.col(Eigen::Index(b))));
    }
    const auto reflectance = asArray(system_.reflectance, system_.bands);
    Fields direction{fields_.radiosity, std::vector<double>(fields_.irradiance.size())};
    for (int k = 0; k < kMostSteps && !convergence_.lastSweep(); ++k) {
      if (std::all_of(krylov.begin(), krylov.end(), [](const auto& b) { return b.exhausted(); })) {
        break;
      }
      auto x = asArray(direction.radiosity, system_.bands);
      for (std::size_t b = 0; b < bands; ++b) {
        x.col(Eigen::Index(b)) = krylov[b].direction().array();
      }
      multiply(system_, direction, convergence_);
      const BandArray image = reflectance * asArray(direction.irradiance, system_.bands);
      for (std::size_t b = 0; b < bands; ++b) {
        krylov[b].add(image.col(Eigen::Index(b)).matrix());
      }
      if (foreseenEnough(krylov, step)) break;
    }
    auto radiosity = asArray(fields_.radiosity, system_.bands);
    for (std::size_t b = 0; b < bands; ++b) {
      radiosity.col(Eigen::Index(b)) += krylov[b].correction().array();
    }
    // B is at least E where no E is negative, so this takes nothing away from B.
    if (system_.nonnegative) radiosity = radiosity.max(asArray(system_.emission, system_.bands));
  }

  /// Records the predicted residual. True if it is within half the tolerance for every patch, or as
  /// small as a cycle can tell.
  bool foreseenEnough(const std::vector<Krylov>& krylov, const BandArray& step) {
    const auto emission = asArray(system_.emission, system_.bands);
    const auto radiosity = asArray(fields_.radiosity, system_.bands);
    const double tolerance = 0.5 * convergence_.tolerance();
    double largest = 0;
    bool enough = true;
    bool exhausted = true;
    for (std::size_t k = 0; k < krylov.size(); ++k) {
      const auto b = Eigen::Index(k);
      const Eigen::ArrayXd left = krylov[k].residual().array().abs();
      const double most = left.maxCoeff();
      largest = std::max(largest, most / largest_[b]);
      exhausted = exhausted && most <= kTrueReduction * step.col(b).abs().maxCoeff();
      if (most <= tolerance * largest_[b] && system_.nonnegative) {
        const Eigen::ArrayXd own =
            (radiosity.col(b) + krylov[k].correction().array()).max(emission.col(b));
        enough = enough && (left <= kOwnShare * tolerance * own + kOwnRounding * largest_[b]).all();
      }
    }
    convergence_.record(largest);
    return exhausted || (enough && largest <= tolerance);
  }

  const System& system_;
  Convergence& convergence_;
  Eigen::ArrayXd largest_;
  Fields fields_;
};

}  // namespace

Fields gmres(const System& system, Convergence& convergence) {
  return Gmres(system, convergence).run();
}

}  // namespace radiosity
