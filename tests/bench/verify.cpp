#include "verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

#include "formfactor/rays/ray_caster.h"

namespace radiosity::bench {
namespace {

constexpr std::uint32_t kRays = 1u << 20;
constexpr std::size_t kRowsCast = 8;
/// An entry is judged by the normal distribution where it expects that many hits or more.
constexpr double kFewestHits = 50;
/// Of some thousand entries a correct one is off by 5.5 standard deviations once in 10^4 runs.
constexpr double kMostDeviations = 5.5;
/// Share of rays that single precision puts on the wrong side of an edge, of one entry or of all.
constexpr double kRounding = 1e-5;
/// Between the two ends of a pair, in accuracies aimed at. A pair that ran out of points may be off
/// by some dozens of them, which is still far below the errors that are measured.
constexpr double kAsymmetry = 100;

struct RayCheck {
  double largest_deviation = 0;  ///< standard deviations, worst entry
  double rms_deviation = 0;
  double largest_front = 0;  ///< |share of fronts - row sum of truth| over the allowed one
  std::size_t entries = 0;
};

RayCheck checkAgainstRays(const PatchMesh& mesh, const TruthRows& truth) {
  const RayCaster caster(mesh);
  RayCheck check;
  double squares = 0;
  const std::size_t rows = std::min(kRowsCast, truth.index.size());
  for (std::size_t r = 0; r < rows; ++r) {
    const std::size_t k = (2 * r + 1) * truth.index.size() / (2 * rows);
    std::array<RayCaster::Counts, kReplicates> counts;
    for (RayCaster::Counts& of : counts) of.clear(caster.items());
    caster.cast(caster.origins(truth.index[k]), truth.index[k] * kReplicates, 0,
                kRays / kReplicates, counts);
    std::vector<std::uint32_t>& hits = counts[0].hits;
    std::transform(hits.begin(), hits.end(), counts[1].hits.begin(), hits.begin(), std::plus());
    double fronts = 0;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      const double expected = truth.row[k][j] * kRays;
      fronts += hits[j];
      if (expected < kFewestHits && hits[j] < kFewestHits) continue;
      const double spread = std::sqrt(std::max(expected, 1.0)) + kRounding * hits[j];
      const double deviation = (hits[j] - expected) / spread;
      check.largest_deviation = std::max(check.largest_deviation, std::abs(deviation));
      squares += deviation * deviation;
      ++check.entries;
    }
    const double sum = std::accumulate(truth.row[k].begin(), truth.row[k].end(), 0.0);
    // Rays that slip through an edge are few, and by chance, too.
    const double chance = std::max(0.0, sum * (1 - sum)) + kRounding;
    const double allowed = kMostDeviations * std::sqrt(chance / kRays) + kRounding;
    check.largest_front = std::max(check.largest_front, std::abs(fronts / kRays - sum) / allowed);
  }
  check.rms_deviation = std::sqrt(squares / double(std::max<std::size_t>(check.entries, 1)));
  return check;
}

/// Largest |A_i F_ij - A_j F_ji| / max(A_i, A_j), in mean form factors, over pairs of known rows.
double largestAsymmetry(const PatchMesh& mesh, const TruthRows& truth) {
  double largest = 0;
  for (std::size_t k = 0; k < truth.index.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      const Index i = truth.index[k];
      const Index j = truth.index[l];
      const double difference = mesh.area[i] * truth.row[k][j] - mesh.area[j] * truth.row[l][i];
      largest = std::max(largest, std::abs(difference) / std::max(mesh.area[i], mesh.area[j]));
    }
  }
  return largest * double(mesh.size());
}

}  // namespace

bool verifyTruth(const BenchScene& scene, const TruthRows& truth, double accuracy) {
  const RayCheck rays = checkAgainstRays(scene.mesh, truth);
  const double asymmetry = largestAsymmetry(scene.mesh, truth);
  const bool good = rays.entries > 0 && rays.largest_deviation < kMostDeviations &&
                    rays.largest_front < 1 && asymmetry < kAsymmetry * accuracy;
  fmt::print(
      "  truth: {} of {} rows; against {} rays each in {} entries: rms {:.2f}, largest {:.2f} "
      "standard deviations; row sums off by {:.2f} of what is allowed; asymmetry {:.1e} of 1/N{}\n",
      truth.index.size(), scene.mesh.size(), kRays, rays.entries, rays.rms_deviation,
      rays.largest_deviation, rays.largest_front, asymmetry, good ? "" : ": NOT VERIFIED");
  return good;
}

}  // namespace radiosity::bench
