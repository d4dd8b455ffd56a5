#include "formfactor/rays/aimed_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/geometry/box.h"
#include "formfactor/rays/patch_points.h"

namespace radiosity {
namespace {

/// Ways from a point to a wide light. 64 if it sees a part of it (a penumbra has steps of 1.6%) or
/// they bring light unevenly, so that their standard deviation is this share of their mean; ...
constexpr std::size_t kWays = 16;
constexpr std::size_t kMoreWays = 64;
constexpr double kUneven = 0.2;
/// ... and the most where it is a tenth of its size away. Then a square is right to 1% down to
/// that.
constexpr std::size_t kMostWays = 1024;
constexpr double kVeryUneven = 2;
/// Points of a patch, in each of two halves: at first, then as many as the tolerance takes. Shadows
/// of less than a hundredth of the patch may fall between the first ones.
constexpr std::array<std::size_t, 3> kPoints{64, 512, 4096};
static_assert(kPoints.back() <= kMostPoints);
/// Of all light on a patch.
constexpr double kPatchTolerance = 2.5e-3;
constexpr std::size_t kHalves = 2;

/// The first 2^n of these are a net of the unit square: one in each of 2^n rectangles, whatever
/// their shape (Sobol's first two dimensions; Kollig & Keller, "Efficient multidimensional
/// sampling", 2002).
Vec2 netPoint(std::size_t number) {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  std::uint32_t bit = 1U << 31U;
  std::uint32_t row = bit;
  for (auto left = std::uint32_t(number); left != 0; left >>= 1U) {
    if ((left & 1U) != 0) {
      x |= bit;
      y ^= row;
    }
    bit >>= 1U;
    row ^= row >> 1U;
  }
  return {double(x) * 0x1p-32, double(y) * 0x1p-32};
}

/// The standard deviation over the mean; 0 of nothing.
double unevenness(std::span<const double> values) {
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const double count = double(values.size());
  return sum > 0 ? std::sqrt(std::max(0.0, count * squares / (sum * sum) - 1)) : 0.0;
}

double over(const std::vector<double>& strength) {
  double sum = 0;
  for (const double value : strength) sum += value;
  return sum;
}

}  // namespace

/// Ways from a point to lights.
struct AimedLight::Ways {
  std::vector<std::size_t> light;
  std::vector<Vec3> to;
  std::vector<double> share;  ///< what each brings of the light's strength
  std::vector<std::uint8_t> seen;
  std::vector<Index> there;

  void clear() {
    light.clear();
    to.clear();
    share.clear();
  }
  void look(const PointRays& rays, const RaySource& at) {
    there.assign(to.size(), kNone);
    seen.resize(to.size());
    rays.see(at, to, there, seen);
  }
};

/// Irradiance over the strength, with what stands in the way and without.
struct AimedLight::Found {
  double lit = 0;
  double whole = 0;
};

AimedLight::AimedLight(const PatchMesh& mesh, const PointRays& rays, std::span<const Light> lights)
    : mesh_(mesh), rays_(rays), lights_(aimedLights(lights)) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.add(v);
  beyond_ = 2 * glm::length(box.high - box.low);
}

Vec3 AimedLight::endOf(const Vec3& from, const LightRay& ray) const {
  const bool outside = ray.distance == LightRay::kOutside;
  return from + (outside ? beyond_ : ray.distance) * ray.toward;
}

double AimedLight::add(const RaySource& at, std::span<double> irradiance) const {
  thread_local Ways ways;
  ways.clear();
  double square = 0;
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    if (lights_[l].isWide(at.position)) {
      square += addWide(lights_[l], at, irradiance);
      continue;
    }
    const LightRay ray = lights_[l].ray(at.position, 0, 0);
    const double share = ray.share * glm::dot(at.normal, ray.toward);
    if (!(share > 0)) continue;
    ways.light.push_back(l);
    ways.to.push_back(endOf(at.position, ray));
    ways.share.push_back(share);
  }
  ways.look(rays_, at);
  for (std::size_t k = 0; k < ways.to.size(); ++k) {
    if (ways.seen[k] == 0) continue;
    const std::vector<double>& strength = lights_[ways.light[k]].strength;
    for (std::size_t b = 0; b < irradiance.size(); ++b) {
      irradiance[b] += ways.share[k] * strength[b];
    }
  }
  return square;
}

double AimedLight::addWide(const Light& light, const RaySource& at,
                           std::span<double> irradiance) const {
  thread_local Ways ways;
  const auto look = [&](std::size_t count) {
    ways.clear();
    for (std::size_t k = 0; k < count; ++k) {
      const Vec2 chosen = netPoint(k) + 0.5 / double(count);
      const LightRay ray = light.ray(at.position, chosen.x, chosen.y);
      const double share = ray.share * glm::dot(at.normal, ray.toward) / double(count);
      ways.to.push_back(endOf(at.position, ray));
      ways.share.push_back(std::max(0.0, share));
    }
    ways.look(rays_, at);
  };
  look(kWays);
  const auto seen = std::ranges::count(ways.seen, 1);
  const bool is_part = seen > 0 && seen < std::ptrdiff_t(kWays);
  if (is_part || unevenness(ways.share) > kUneven) look(kMoreWays);
  if (ways.to.size() == kMoreWays && unevenness(ways.share) > kVeryUneven) look(kMostWays);
  // Each half is spread as all are.
  std::array<double, kHalves> lit{};
  for (std::size_t k = 0; k < ways.to.size(); ++k) {
    if (ways.seen[k] != 0) lit[k * kHalves / ways.to.size()] += ways.share[k];
  }
  double square = 0;
  for (std::size_t b = 0; b < irradiance.size(); ++b) {
    irradiance[b] += light.strength[b] * (lit[0] + lit[1]);
    const double off = light.strength[b] * (lit[0] - lit[1]);
    square += off * off;
  }
  return square;
}

std::optional<double> AimedLight::unobstructed(const Light& light, std::size_t patch) const {
  double sum = 0;
  double area = 0;
  const PatchArea pieces(mesh_, patch);
  for (std::size_t k = 0; k < pieces.pieces().size(); ++k) {
    const double of_piece = pieces.sizeOf(k);
    if (!(of_piece > 0)) continue;
    const auto& [a, b, c] = pieces.pieces()[k];
    const std::optional<double> share =
        light.share(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
    if (!share) return std::nullopt;
    sum += of_piece * *share;
    area += of_piece;
  }
  return area > 0 ? sum / area : 0.0;
}

AimedLight::Found AimedLight::atPoints(const Light& light, const PatchPoints& points) const {
  thread_local std::vector<Vec3> from;
  thread_local std::vector<Vec3> to;
  thread_local std::vector<double> share;
  thread_local std::vector<std::uint8_t> seen;
  from.clear();
  to.clear();
  share.clear();
  Found found;
  for (std::size_t k = 0; k < points.at.size(); ++k) {
    const auto& [u, v] = points.of_light[k];
    const LightRay ray = light.ray(points.at[k], u, v);
    const double here = ray.share * glm::dot(points.normal, ray.toward) / double(points.at.size());
    if (!(here > 0)) continue;
    from.push_back(points.at[k]);
    to.push_back(endOf(points.at[k], ray));
    share.push_back(here);
    found.whole += here;
  }
  seen.resize(to.size());
  rays_.see(from, points.normal, points.own, to, {}, seen);
  for (std::size_t k = 0; k < to.size(); ++k) {
    if (seen[k] != 0) found.lit += share[k];
  }
  return found;
}

/// Points tell what is hidden; how much there is they tell only without a closed form. Two halves
/// may agree by chance: an edge is taken to be off by what edges are.
AimedLight::Share AimedLight::overPatch(const Light& light, std::size_t patch,
                                        const PatchPoints& first, const PatchPoints& second) const {
  const Found a = atPoints(light, first);
  const Found b = atPoints(light, second);
  const double lit = (a.lit + b.lit) / 2;
  const double whole = (a.whole + b.whole) / 2;
  if (!(lit > 0)) return {};
  const std::optional<double> closed = unobstructed(light, patch);
  if (closed && lit == whole) return {*closed, 0};
  const double scale = closed.value_or(whole) / whole;
  const double edge = edgeError(first.at.size() + second.at.size()) * whole;
  return {scale * lit, scale * std::max(std::abs(a.lit - b.lit) / 2, edge)};
}

void AimedLight::overPatch(std::size_t patch, const SharpShadows& sharp, std::uint64_t seed,
                           std::span<Share> shares) const {
  std::ranges::fill(shares, Share());
  if (mesh_.polygon[patch] == kNone || !(mesh_.area[patch] > 0)) return;
  std::vector<std::uint8_t> is_exact(lights_.size(), 0);
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const std::optional<double> exact = sharp.share(lights_[l], patch);
    if (!exact) continue;
    shares[l].value = *exact;
    is_exact[l] = 1;
  }
  double all = 0;
  for (const std::size_t count : kPoints) {
    std::optional<PatchPoints> first;
    std::optional<PatchPoints> second;
    for (std::size_t l = 0; l < lights_.size(); ++l) {
      if (is_exact[l] != 0) continue;
      const double strength = over(lights_[l].strength);
      const bool known = all > 0 && !(shares[l].error * strength > kPatchTolerance * all);
      if (known || (count != kPoints.front() && !(shares[l].error > 0))) continue;
      if (!first) {
        first.emplace(mesh_, patch, sobol_, count, seed);
        second.emplace(mesh_, patch, sobol_, count, seed + 1);
      }
      shares[l] = overPatch(lights_[l], patch, *first, *second);
    }
    all = 0;
    for (std::size_t l = 0; l < lights_.size(); ++l) {
      all += shares[l].value * over(lights_[l].strength);
    }
  }
}

}  // namespace radiosity
