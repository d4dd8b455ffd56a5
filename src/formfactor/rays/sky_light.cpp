#include "formfactor/rays/sky_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "formfactor/rays/patch_points.h"

namespace radiosity {
namespace {

/// Rays of a patch, in each of some sets: at first, then as many as the tolerance takes.
constexpr std::size_t kSets = 4;
constexpr std::array<std::size_t, 3> kPoints{64, 256, 1024};
/// So many must get out in all, ...
constexpr std::size_t kFewestOut = 8;
/// ... and by as many random rays the mean would be off by no more than this many tolerances: sets
/// may agree by chance where few rays meet the sun's glare.
constexpr double kRandom = 6;
static_assert(kPoints.back() <= kMostPoints);
/// Of a patch's light, or of this share of what it would get in the open, if that is more.
constexpr double kTolerance = 5e-3;
constexpr double kDim = 0.02;
constexpr std::size_t kRaysOfPoint = 4096;
constexpr std::uint64_t kSeedOfPoints = 0x736b79;

double totalOf(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// The root of the sum of squares.
double sizeOf(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

}  // namespace

/// Of rays alike by the cosine.
struct SkyLight::Sum {
  explicit Sum(std::size_t bands) : radiance(bands, 0.0) {}
  std::vector<double> radiance;    ///< of those that meet nothing
  double squares = 0;              ///< of these, each summed over the bands
  std::size_t open = 0;            ///< how many do
  std::vector<double> unhindered;  ///< of all, if it is asked for by its size
};

SkyLight::SkyLight(const PatchMesh& mesh, const PointRays& rays, std::span<const Light> lights,
                   int bands)
    : mesh_(mesh),
      rays_(rays),
      sky_(unevenSkies(lights), bands),
      of_point_(kRaysOfPoint, kSeedOfPoints),
      beyond_(2 * boxOf(mesh.vertices).diagonal()) {}

void SkyLight::look(std::size_t patch, std::size_t count, std::uint64_t seed, Sum& sum) const {
  const PatchPoints points(mesh_, patch, sobol_, count, seed);
  const PlaneFrame frame = makeFrame(Vec3(0.0), points.normal, axisAcross(points.normal));
  thread_local std::vector<Vec3> along;
  thread_local std::vector<Vec3> to;
  thread_local std::vector<std::uint8_t> seen;
  along.clear();
  to.clear();
  for (std::size_t k = 0; k < count; ++k) {
    // Malley: points alike over the disc, raised to the hemisphere.
    const double square = points.of_light[k][0];
    const double turn = 2 * std::numbers::pi * points.of_light[k][1];
    const double off = std::sqrt(square);
    along.push_back(off * (std::cos(turn) * frame.u + std::sin(turn) * frame.v) +
                    std::sqrt(1 - square) * frame.n);
    to.push_back(points.at[k] + beyond_ * along.back());
  }
  seen.resize(count);
  rays_.see(points.at, points.normal, points.own, to, {}, seen);
  for (std::size_t k = 0; k < count; ++k) {
    if (!sum.unhindered.empty()) sky_.add(along[k], 1, sum.unhindered);
    if (seen[k] == 0) continue;
    ++sum.open;
    const double before = totalOf(sum.radiance);
    sky_.add(along[k], 1, sum.radiance);
    const double brought = totalOf(sum.radiance) - before;
    sum.squares += brought * brought;
  }
}

/// The ratio of two sums over the same rays: what it is off by is how radiance varies over what is
/// open, not how much is open. Where hardly a ray gets out it is taken over all directions. The
/// error is that of a ratio of means of sets (Cochran, Sampling Techniques, 6.4): two sets would
/// often agree by chance.
double SkyLight::overPatch(std::size_t patch, double open, std::uint64_t seed,
                           std::span<double> irradiance) const {
  if (!(open > 0) || mesh_.polygon[patch] == kNone || !(mesh_.area[patch] > 0)) return 0;
  const double factor = std::numbers::pi * open;
  std::vector<double> mean;
  double square = 0;
  double in_the_open = 0;
  for (const std::size_t count : kPoints) {
    std::vector<Sum> sets(kSets, Sum(irradiance.size()));
    if (count == kPoints.front()) sets[0].unhindered.assign(irradiance.size(), 0.0);
    std::size_t out = 0;
    double squares = 0;
    double total = 0;
    for (std::size_t set = 0; set < kSets; ++set) {
      look(patch, count, seed + set, sets[set]);
      out += sets[set].open;
      squares += sets[set].squares;
      total += totalOf(sets[set].radiance);
    }
    if (count == kPoints.front()) {
      mean = std::move(sets[0].unhindered);
      for (double& value : mean) value *= factor / double(count);
      square = sizeOf(mean) * sizeOf(mean);
      in_the_open = sizeOf(mean) / open;
    }
    if (out >= kFewestOut) {
      square = 0;
      for (std::size_t b = 0; b < mean.size(); ++b) {
        double sum = 0;
        for (const Sum& set : sets) sum += set.radiance[b];
        const double ratio = sum / double(out);
        mean[b] = factor * ratio;
        for (const Sum& set : sets) {
          const double off = factor * (set.radiance[b] - ratio * double(set.open)) / double(out);
          square += off * off * double(kSets) / double(kSets - 1);
        }
      }
    }
    const double allowed = kTolerance * std::max(sizeOf(mean), kDim * in_the_open);
    if (square > allowed * allowed) continue;
    if (out < kFewestOut) break;  // next to nothing is open
    // The square of what random rays are off by, over that of the mean.
    const double random = squares / (total * total) - 1 / double(out);
    const double most = kRandom * allowed / sizeOf(mean);
    if (!(random > most * most)) break;
  }
  for (std::size_t b = 0; b < mean.size(); ++b) irradiance[b] += mean[b];
  return square;
}

void SkyLight::add(const RaySource& at, std::span<double> irradiance) const {
  thread_local std::vector<RayEnd> ends;
  ends.resize(of_point_.rays());
  const HemisphereSet::Turn turn = of_point_.turnAt(at.position + at.normal, kSeedOfPoints);
  rays_.look(at, of_point_, turn.set, turn.angle, ends);
  const auto counts = [](const RayEnd& end) { return end.patch != RayEnd::kOwn; };
  const double each =
      std::numbers::pi / double(std::max<std::ptrdiff_t>(1, std::ranges::count_if(ends, counts)));
  for (const RayEnd& end : ends) {
    if (end.patch == RayEnd::kSky) sky_.add(end.at, each, irradiance);
  }
}

}  // namespace radiosity
