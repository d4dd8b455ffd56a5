#include "formfactor/exact/coverage.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace radiosity {

void Coverage::begin(const ConvexPolygon& target, const Vec3& normal, const Vec2& shift) {
  samples_.clear();
  weights_.clear();
  // Bilinear over the first four corners and, of a pentagon, over the triangle that is left.
  const auto& c = target.corners;
  for (std::size_t first = 0; first + 2 < c.size(); first += 2) {
    const Vec3& p00 = c[0];
    const Vec3& p10 = c[first + 1];
    const Vec3& p11 = c[first + 2];
    const Vec3& p01 = c[std::min(first + 3, c.size() - 1)];
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const double u = (i + shift.x) / kSide;
        const double v = (j + shift.y) / kSide;
        const Vec3 p = (p00 * (1 - u) + p10 * u) * (1 - v) + (p01 * (1 - u) + p11 * u) * v;
        const Vec3 along_u = (p10 - p00) * (1 - v) + (p11 - p01) * v;
        const Vec3 along_v = (p01 - p00) * (1 - u) + (p11 - p10) * u;
        const double r2 = glm::dot(p, p);
        // Both cosines without the normal of the target: -p . (area element).
        const double facing = -glm::dot(p, glm::cross(along_u, along_v));
        samples_.push_back(p);
        weights_.push_back(std::max(0.0, glm::dot(normal, p) * facing) / (r2 * r2));
      }
    }
  }
  hidden_.assign(samples_.size(), 0);
  left_ = samples_.size();
}

bool Coverage::draw(const BlockingCone& cone) {
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    if (hidden_[k]) continue;
    bool inside = true;
    for (const ClipPlane& plane : cone.planes) inside &= plane.distance(samples_[k]) > 0;
    hidden_[k] = std::uint8_t(inside);
    left_ -= inside;
  }
  return left_ > 0;
}

double Coverage::visibleFraction() const {
  double seen = 0;
  double all = 0;
  for (std::size_t k = 0; k < samples_.size(); ++k) {
    all += weights_[k];
    if (!hidden_[k]) seen += weights_[k];
  }
  return all > 0 ? seen / all : 0;
}

}  // namespace radiosity
