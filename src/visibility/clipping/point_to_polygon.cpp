#include "visibility/clipping/point_to_polygon.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace radiosity {

double pointToPolygon(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon) {
  double sum = 0;
  for (std::size_t k = 0, last = polygon.size() - 1; k < polygon.size(); last = k++) {
    const Vec3 a = polygon[last] - point;
    const Vec3 b = polygon[k] - point;
    const Vec3 c = glm::cross(a, polygon[k] - polygon[last]);
    const double s = glm::length(c);
    const double d = glm::dot(a, b);
    if (s > 0) {
      sum += glm::dot(normal, c) * (std::atan2(s, d) / s);
    }
  }
  return -sum / (2 * std::numbers::pi);
}

}  // namespace radiosity
