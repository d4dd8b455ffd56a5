// Direct light as elements have it, and indirect light by rays in all directions.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/finite.h"
#include "base/geometry/plane_frame.h"
#include "base/hash.h"
#include "base/luminance.h"
#include "base/option_list.h"
#include "base/parallel.h"
#include "base/processor_clock.h"
#include "elements/light_sources.h"
#include "elements/ray_light.h"
#include "illuminance/clipped_light.h"
#include "illuminance/directions.h"

namespace radiosity {
namespace {

/// A point is taken off its surface by this share of the scene's diagonal, some ten times what
/// rounds off in single precision.
constexpr double kOffSurface = 2e-6;
/// A point stands in a body if more than this share of all directions end on black backs: from
/// behind an endless sheet it is a half.
constexpr double kMostlyBacks = 0.6;

/// Occluders that are clipped off an emitter: of a surface that faces as the point does, and of the
/// many others.
constexpr std::size_t kMostClips = 256;
constexpr std::size_t kMostQuickClips = 16;
/// Of the tolerance, what direct light takes where it is found by rays.
constexpr double kShareOfDirect = 0.5;

void requirePoints(std::span<const Vec3> points, std::span<const Vec3> normals) {
  if (normals.size() != points.size()) {
    throw InputError(
        fmt::format("illuminance: {} points and {} normals were given; give one normal a point",
                    points.size(), normals.size()));
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!isFinite(points[k])) {
      throw InputError(
          fmt::format("illuminance: point {} has a coordinate that is no finite number", k));
    }
    if (!isFinite(normals[k]) || !(glm::length(normals[k]) > 0)) {
      throw InputError(fmt::format(
          "illuminance: normal {} has no direction; give a finite vector that is not 0", k));
    }
  }
}

/// PointLightValues::open_lux.
double openLux(const PatchMaterials& materials) {
  const auto bands = std::size_t(materials.bands);
  if (!isPhotometric(materials.bands)) return 0;
  if (std::ranges::any_of(materials.emission, [](double value) { return value > 0; })) return 0;
  std::vector<double> ground(bands, 0.0);
  for (const Light& light : materials.lights) {
    if (!light.shines()) continue;
    for (std::size_t b = 0; b < bands; ++b) {
      const std::optional<double> here = light.overcast(b);
      if (!here) return 0;
      ground[b] += *here;
    }
  }
  return photometricOf(ground);
}

/// Sums of one of the sets of rays.
struct SetSums {
  std::vector<double> light;  ///< kMeasured * bands: of weight times radiosity
  std::array<double, kMeasured> weight{};
};

class PointMeter {
 public:
  PointMeter(const PatchMesh& mesh, const PatchMaterials& materials,
             std::span<const double> irradiance, const ElementOptions& elements, Up up,
             const IlluminanceOptions& options, Progress& progress)
      : bands_(std::size_t(materials.bands)),
        options_(options),
        up_(up),
        nothing_wanted_(mesh.size(), 0),
        sources_(mesh, materials, irradiance, elements, nothing_wanted_, false, progress),
        light_(sources_.sources(), materials.lights),
        clipped_(mesh, materials, progress),
        sets_(options.seed),
        cube_(cubeNormals()),
        uprights_(uprightNormals(up)) {}

  DirectLight direct() const { return sources_.report().direct; }
  /// Fills the row of point k; returns the number of rays.
  std::size_t measure(const Vec3& at, const Vec3& normal, std::size_t k,
                      PointLightValues& out) const;

 private:
  std::span<double> rowOf(std::vector<double>& values, std::size_t point, std::size_t what) const {
    return std::span(values).subspan((point * kMeasured + what) * bands_, bands_);
  }
  double addDirect(SurfacePoint point, const Vec3& normal, bool fine, std::span<double> sum) const;
  double direct(const SurfacePoint& point, std::size_t k, PointLightValues& out) const;
  void castMore(const SurfacePoint& point, std::size_t first, std::size_t count,
                std::array<SetSums, SphereSets::kSets>& sums, std::size_t& behind) const;
  double errorOf(const std::array<SetSums, SphereSets::kSets>& sums) const;

  std::size_t bands_;
  IlluminanceOptions options_;
  Up up_;
  std::vector<std::uint8_t> nothing_wanted_;
  LightSources sources_;
  RayLight light_;
  ClippedLight clipped_;
  SphereSets sets_;
  std::array<Vec3, kCubeFaces> cube_;
  std::array<Vec3, kUprights> uprights_;
};

/// Clips if few occluders are in between, else casts rays. `fine`: more of either. Returns the
/// square of the standard error, summed over the bands.
double PointMeter::addDirect(SurfacePoint point, const Vec3& normal, bool fine,
                             std::span<double> sum) const {
  const EmitterLight& emitters = *sources_.emitterLight();
  point.normal = normal;
  const std::size_t most = fine ? kMostClips : kMostQuickClips;
  if (!clipped_.empty() && clipped_.add(point.position, normal, most, sum)) {
    return emitters.aimedAt(point, sum);
  }
  if (!fine) return emitters.irradiance(point, nullptr, sum);
  return emitters.aimedAt(point, sum) +
         emitters.emittedWithin(point, kShareOfDirect * options_.tolerance, sum);
}

/// Returns the standard error of what falls on the point, facing, as brightness.
double PointMeter::direct(const SurfacePoint& point, std::size_t k, PointLightValues& out) const {
  if (sources_.emitterLight() == nullptr) return 0;
  const std::span<double> facing = rowOf(out.direct, k, 0);
  const double square = addDirect(point, point.normal, true, facing);
  for (std::size_t face = 0; face < kCubeFaces; ++face) {
    addDirect(point, cube_[face], false, rowOf(out.direct, k, 1 + face));
  }
  const std::span<double> cylinder = rowOf(out.direct, k, std::size_t(Measured::cylinder));
  for (const Vec3& normal : uprights_) addDirect(point, normal, false, cylinder);
  for (double& value : cylinder) value /= double(kUprights);
  const double all = std::accumulate(facing.begin(), facing.end(), 0.0);
  return all > 0 ? std::sqrt(std::max(0.0, square)) / all * brightnessOf(facing) : 0.0;
}

/// Rays `first` to `first` + `count` of each set, turned about the normal by a hash of the place.
void PointMeter::castMore(const SurfacePoint& point, std::size_t first, std::size_t count,
                          std::array<SetSums, SphereSets::kSets>& sums, std::size_t& behind) const {
  Hash hash;
  hash.bytes(&point.place, sizeof point.place);
  hash.bytes(&options_.seed, sizeof options_.seed);
  const double turn = 2 * std::numbers::pi * double(mixed(hash.value()) >> 11) * 0x1p-53;
  const PlaneFrame frame = makeFrame(point.position, point.normal, axisAcross(point.normal));
  const Vec3 x = std::cos(turn) * frame.u + std::sin(turn) * frame.v;
  const Vec3 y = std::cos(turn) * frame.v - std::sin(turn) * frame.u;
  const Weights weights(point.normal, up_);
  thread_local std::vector<Vec3> along;
  thread_local std::vector<RayEnd> ends;
  thread_local std::vector<double> brought;
  along.resize(count);
  ends.resize(count);
  for (std::size_t set = 0; set < SphereSets::kSets; ++set) {
    const std::span<const Vec3> directions = sets_.directions(set, first, count);
    for (std::size_t r = 0; r < count; ++r) {
      const Vec3& d = directions[r];
      along[r] = d.x * x + d.y * y + d.z * frame.n;
    }
    sources_.rays().trace(point.position, along, ends);
    SetSums& sum = sums[set];
    for (std::size_t r = 0; r < count; ++r) {
      if (ends[r].patch == RayEnd::kBlack) ++behind;
      brought.assign(bands_, 0.0);
      light_.add(ends[r], point.position, brought);
      const std::array<double, kMeasured> weight = weights.of(along[r]);
      for (std::size_t what = 0; what < kMeasured; ++what) {
        sum.weight[what] += weight[what];
        for (std::size_t b = 0; b < bands_; ++b) {
          sum.light[what * bands_ + b] += weight[what] * brought[b];
        }
      }
    }
  }
}

/// The standard error of the mean of all sets, facing, as brightness.
double PointMeter::errorOf(const std::array<SetSums, SphereSets::kSets>& sums) const {
  std::array<double, SphereSets::kSets> of{};
  double mean = 0;
  for (std::size_t set = 0; set < SphereSets::kSets; ++set) {
    of[set] = brightnessOf(std::span(sums[set].light).first(bands_)) / sums[set].weight[0];
    mean += of[set] / double(SphereSets::kSets);
  }
  double square = 0;
  for (const double value : of) square += (value - mean) * (value - mean);
  return std::sqrt(square / double(SphereSets::kSets * (SphereSets::kSets - 1)));
}

std::size_t PointMeter::measure(const Vec3& at, const Vec3& normal, std::size_t k,
                                PointLightValues& out) const {
  SurfacePoint point;
  point.place = at;
  point.normal = glm::normalize(normal);
  point.position = at + kOffSurface * sources_.surface().diagonal * point.normal;
  point.inner = point.position;
  point.owners = sources_.surface().nobody;
  const double off = direct(point, k, out);
  const double direct_light = brightnessOf(rowOf(out.direct, k, 0));

  std::array<SetSums, SphereSets::kSets> sums;
  for (SetSums& sum : sums) sum.light.assign(kMeasured * bands_, 0.0);
  std::size_t behind = 0;
  std::size_t cast = 0;
  const std::size_t most = options_.most_rays / SphereSets::kSets;
  double error = 0;
  double indirect = 0;
  for (std::size_t until = SphereSets::kFewest; until <= most; until *= 2) {
    castMore(point, cast, until - cast, sums, behind);
    cast = until;
    indirect = 0;
    for (const SetSums& sum : sums) {
      indirect += brightnessOf(std::span(sum.light).first(bands_)) / sum.weight[0] /
                  double(SphereSets::kSets);
    }
    error = errorOf(sums);
    const double allowed = options_.tolerance * (direct_light + indirect);
    if (error * error <= std::max(allowed * allowed - off * off, 0.25 * allowed * allowed)) break;
  }
  for (std::size_t what = 0; what < kMeasured; ++what) {
    const std::span<double> row = rowOf(out.indirect, k, what);
    for (const SetSums& sum : sums) {
      for (std::size_t b = 0; b < bands_; ++b) {
        row[b] += sum.light[what * bands_ + b] / sum.weight[what] / double(SphereSets::kSets);
      }
    }
  }
  const std::size_t rays = cast * SphereSets::kSets;
  const double all = direct_light + indirect;
  out.error[k] = all > 0 ? std::hypot(error, off) / all : 0.0;
  out.inside[k] = double(behind) > kMostlyBacks * double(rays) ? 1 : 0;
  return rays;
}

}  // namespace

void IlluminanceOptions::validate() const { requireRanges(*this); }

PointLightValues lightAtPoints(const PatchMesh& mesh, const PatchMaterials& materials,
                               std::span<const double> irradiance, const ElementOptions& elements,
                               std::span<const Vec3> points, std::span<const Vec3> normals, Up up,
                               const IlluminanceOptions& options, Progress& progress) {
  options.validate();
  elements.validate();
  requireSizes(mesh, materials, irradiance, {});
  requirePoints(points, normals);
  const PointMeter meter(mesh, materials, irradiance, elements, up, options, progress);
  PointLightValues out;
  out.bands = materials.bands;
  out.up = up;
  out.open_lux = openLux(materials);
  out.direct.assign(points.size() * kMeasured * std::size_t(materials.bands), 0.0);
  out.indirect.assign(out.direct.size(), 0.0);
  out.error.assign(points.size(), 0.0);
  out.inside.assign(points.size(), 0);
  std::vector<std::size_t> rays(points.size(), 0);
  const Stopwatch watch;
  progress.begin("illuminance", points.size(), "points");
  parallelFor(points.size(), 1, [&](std::size_t k) {
    if (progress.cancelled()) return;
    rays[k] = meter.measure(points[k], normals[k], k, out);
    progress.advance();
  });
  progress.check();
  progress.end();
  out.report.direct = meter.direct();
  out.report.seconds = watch.seconds();
  double squares = 0;
  std::size_t outside = 0;  // of bodies
  for (std::size_t k = 0; k < points.size(); ++k) {
    out.report.rays += double(rays[k]);
    out.report.most_rays = std::max(out.report.most_rays, rays[k]);
    if (out.inside[k] != 0) continue;
    ++outside;
    if (out.error[k] > out.report.largest_error) {
      out.report.largest_error = out.error[k];
      out.report.largest_error_at = k;
    }
    squares += out.error[k] * out.error[k];
  }
  out.report.ray_error = outside == 0 ? 0 : std::sqrt(squares / double(outside));
  return out;
}

}  // namespace radiosity
