// Points that shine.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/finite.h"
#include "radiosity/light.h"

namespace radiosity {

namespace {

/// With the share of an intensity that does not depend on direction. At the point itself there is
/// no way to it.
LightRay wayTo(const Vec3& at, const Vec3& place, double range) {
  const Vec3 way = at - place;
  const double square = glm::dot(way, way);
  if (!(square > 0)) return {};
  const double distance = std::sqrt(square);
  const double fourth = range > 0 ? std::pow(distance / range, 4) : 0.0;
  return {way / distance, distance, std::max(0.0, 1 - fourth) / square};
}

double cosineOf(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

}  // namespace

LightRay PointLight::ray(const Vec3& place, double /*u*/, double /*v*/) const {
  return wayTo(at, place, range);
}

// tan(Omega / 2) = a . (b x c) / (|a| |b| |c| + (a . b) |c| + (b . c) |a| + (c . a) |b|).
std::optional<double> PointLight::share(const Vec3& corner_a, const Vec3& corner_b,
                                        const Vec3& corner_c) const {
  if (range > 0) return std::nullopt;
  const Vec3 a = corner_a - at;
  const Vec3 b = corner_b - at;
  const Vec3 c = corner_c - at;
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  // The triple product by edges: the corners of small triangles far away are nearly parallel.
  const Vec3 twice_area = glm::cross(b - a, c - a);
  const double volume = std::abs(glm::dot(a, twice_area));
  const double angle = 2 * std::atan2(volume, la * lb * lc + glm::dot(a, b) * lc +
                                                  glm::dot(b, c) * la + glm::dot(c, a) * lb);
  return angle / (0.5 * glm::length(twice_area));
}

LightRay SpotLight::ray(const Vec3& place, double /*u*/, double /*v*/) const {
  LightRay ray = wayTo(at, place, range);
  const double cosine = -glm::dot(ray.toward, glm::normalize(aim - at));
  const double end = cosineOf(outer);
  const double ramp = cosineOf(inner) - end;
  const double share =
      ramp > 0 ? std::clamp((cosine - end) / ramp, 0.0, 1.0) : double(cosine > end);
  ray.share *= share * share;
  return ray;
}

double SpotLight::power() const {
  const double begin = cosineOf(inner);
  return 2 * std::numbers::pi * (1 - begin + (begin - cosineOf(outer)) / 3);
}

void SpotLight::validate() const {
  if (!isFinite(at) || !isFinite(aim) || at == aim) {
    throw InputError("a spot needs two finite places, other than each other: at and aim");
  }
  if (inner > outer) {
    throw InputError(fmt::format(
        "a spot of inner {} degrees and outer {}: give inner at most outer", inner, outer));
  }
}

}  // namespace radiosity
