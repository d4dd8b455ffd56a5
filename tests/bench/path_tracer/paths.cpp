#include "path_tracer/paths.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace radiosity::bench {
namespace {

constexpr int kSureBounces = 4;

/// Directions spread by the cosine about n.
Vec3 cosineDirection(const Vec3& n, const Vec2& at) {
  const double turn = 2 * std::numbers::pi * at.y;
  const double r = std::sqrt(at.x);
  const Vec3 across = glm::normalize(std::abs(n.x) < 0.6 ? glm::cross(n, Vec3(1, 0, 0))
                                                         : glm::cross(n, Vec3(0, 1, 0)));
  return r * std::cos(turn) * across + r * std::sin(turn) * glm::cross(n, across) +
         std::sqrt(1 - at.x) * n;
}

/// Where a path stands.
struct Place {
  Vec3 at{0.0};
  Vec3 facet{0.0};   ///< normal of the facet
  Vec3 normal{0.0};  ///< that light falls by
  double edge = 0;   ///< longest of the facet
  bool smooth = false;

  /// Rays that leave below the facet, but above the smooth surface that it stands for, would end in
  /// the body behind it: they start an edge farther on.
  double start(const Vec3& along) const {
    return smooth && glm::dot(along, facet) < 0.01 * glm::length(along) ? edge : 0;
  }
};

/// Radiance reflected from a place of reflectance 1 that comes from one point of what shines.
/// `alone`: no ray of the next direction will bring it.
Vec3 aimedLight(const TracedScene& scene, const Place& place, bool alone, ScrambledPoints& points) {
  const double choice = points.next().x;
  const LightSample light = scene.light(choice, points.next());
  const Vec3 along = light.at - place.at;
  const double square = glm::dot(along, along);
  const double length = std::sqrt(square);
  const double cos_here = glm::dot(along, place.normal) / length;
  const double cos_there = -glm::dot(along, light.normal) / length;
  if (!(cos_here > 0 && cos_there > 0)) return Vec3(0.0);
  if (!scene.sees(place.at, light.at + scene.lift() * light.normal, place.start(along))) {
    return Vec3(0.0);
  }
  const double by_aim = light.side->aim * square / cos_there;
  const double by_chance = alone ? 0 : cos_here / std::numbers::pi;
  return light.side->emission *
         (std::numbers::inv_pi * std::numbers::inv_pi * cos_here / (by_aim + by_chance));
}

/// Radiance reflected from a place of reflectance 1 that comes from lamps without a surface.
Vec3 lampLight(const TracedScene& scene, const Place& place, ScrambledPoints& points) {
  Vec3 radiance(0.0);
  for (const Light& lamp : scene.lamps()) {
    const Vec2 choice = points.next();
    const LightRay ray = lamp.ray(place.at, choice.x, choice.y);
    const double cosine = glm::dot(ray.toward, place.normal);
    if (!(cosine > 0 && ray.share > 0)) continue;
    const Vec3 end = place.at + ray.toward * std::min(ray.distance, scene.beyond());
    if (!scene.sees(place.at, end, place.start(ray.toward))) continue;
    const Vec3 strength(lamp.strength[0], lamp.strength[1], lamp.strength[2]);
    radiance += strength * (std::numbers::inv_pi * cosine * ray.share);
  }
  return radiance;
}

}  // namespace

PathLight tracePath(const TracedScene& scene, const Vec3& eye, const Vec3& direction,
                    const PathOptions& options, ScrambledPoints& points) {
  PathLight light;
  TracedHit hit = scene.hit(eye, direction, 0, true);
  if (hit.triangle == kNone) {
    light.misses = true;
    light.radiance = scene.sky(direction, true);
    return light;
  }
  const Vec3 shines = scene.triangle(hit.triangle).side[hit.side].emission;
  light.emits = shines != Vec3(0.0);
  light.radiance = shines * std::numbers::inv_pi;
  Vec3 weight(1.0);
  for (int bounce = 1;; ++bounce) {
    const TracedTriangle& on = scene.triangle(hit.triangle);
    Place place{hit.at + scene.lift() * hit.normal, hit.normal, hit.normal, on.longest_edge};
    if (bounce == 1 && options.smooth && on.smooth) {
      place.smooth = true;
      place.normal = hit.smooth_normal;
    }
    weight *= on.side[hit.side].reflectance;
    if (weight == Vec3(0.0)) return light;
    light.radiance += weight * lampLight(scene, place, points);
    if (scene.anythingShines()) {
      light.radiance += weight * aimedLight(scene, place, place.smooth, points);
    }
    if (bounce > kSureBounces) {
      const double goes_on = std::min(0.95, std::max({weight.x, weight.y, weight.z}));
      if (!(points.next().x < goes_on)) return light;
      weight /= goes_on;
    }
    Vec3 along = cosineDirection(place.normal, points.next());
    // Light from below the facet's horizon falls on no facet.
    while (place.smooth && !(glm::dot(along, place.facet) > 0)) {
      along = cosineDirection(place.normal, points.next());
    }
    hit = scene.hit(place.at, along, 0, false);
    if (hit.triangle == kNone) {
      light.radiance += weight * scene.sky(along, false);
      return light;
    }
    const TracedSide& side = scene.triangle(hit.triangle).side[hit.side];
    if (side.black) return light;
    if (side.emission != Vec3(0.0) && !place.smooth) {
      const Vec3 between = hit.at - place.at;
      const double cos_there = -glm::dot(along, hit.normal);
      const double by_aim = side.aim * glm::dot(between, between) / std::max(cos_there, 1e-12);
      const double by_chance = glm::dot(along, place.normal) * std::numbers::inv_pi;
      light.radiance +=
          weight * side.emission * (std::numbers::inv_pi * by_chance / (by_aim + by_chance));
    }
    if (bounce == options.most_bounces) return light;
  }
}

}  // namespace radiosity::bench
