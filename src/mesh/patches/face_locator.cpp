#include "mesh/patches/face_locator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/geometry/segment.h"
#include "mesh/triangulate.h"

namespace radiosity {

FaceLocator::FaceLocator(const Scene& scene, std::span<const Index> faces, const PlaneFrame& frame,
                         const Vec3& origin)
    : frame_(frame) {
  for (const Index f : faces) {
    const auto outline = scene.face(f);
    std::vector<Vec2> flat;
    std::vector<double> height;
    for (const Index v : outline) {
      const Vec3 p = scene.vertices[v] - origin;
      flat.push_back(frame.flat(p));
      height.push_back(glm::dot(p - frame.origin, frame.n));
    }
    for (const auto& t : triangulateOutline(flat)) {
      const std::size_t first = scene.face_offset[f];
      triangles_.push_back({f,
                            {first + t[0], first + t[1], first + t[2]},
                            {flat[t[0]], flat[t[1]], flat[t[2]]},
                            {height[t[0]], height[t[1]], height[t[2]]}});
    }
  }
  lower_ = triangles_.front().p[0];
  Vec2 upper = lower_;
  for (const Triangle& t : triangles_) {
    for (const Vec2& p : t.p) {
      lower_ = glm::min(lower_, p);
      upper = glm::max(upper, p);
    }
  }
  const std::size_t side = std::size_t(std::ceil(std::sqrt(double(triangles_.size()))));
  for (int axis = 0; axis < 2; ++axis) {
    const double extent = upper[axis] - lower_[axis];
    count_[std::size_t(axis)] = extent > 0 ? side : 1;
    inverse_cell_[axis] = extent > 0 ? double(side) / extent : 0.0;
  }
  grid_.resize(count_[0] * count_[1]);
  for (Index k = 0; k < triangles_.size(); ++k) {
    const auto& p = triangles_[k].p;
    const Vec2 low = glm::min(p[0], glm::min(p[1], p[2]));
    const Vec2 high = glm::max(p[0], glm::max(p[1], p[2]));
    for (std::size_t j = cell(low.y, 1); j <= cell(high.y, 1); ++j) {
      for (std::size_t i = cell(low.x, 0); i <= cell(high.x, 0); ++i) {
        grid_[j * count_[0] + i].push_back(k);
      }
    }
  }
}

std::size_t FaceLocator::cell(double x, int axis) const {
  const double c = std::floor((x - lower_[axis]) * inverse_cell_[axis]);
  return std::size_t(std::clamp(c, 0.0, double(count_[std::size_t(axis)] - 1)));
}

FaceLocator::Place FaceLocator::place(const Triangle& t, const Vec2& q) const {
  const double whole = cross2(t.p[1] - t.p[0], t.p[2] - t.p[0]);
  Place result{t.face, t.corners, {1.0, 0.0, 0.0}};
  if (whole != 0) {
    const double second = cross2(q - t.p[0], t.p[2] - t.p[0]) / whole;
    const double third = cross2(t.p[1] - t.p[0], q - t.p[0]) / whole;
    result.weights = {1 - second - third, second, third};
  }
  return result;
}

FaceLocator::Place FaceLocator::locate(const Vec3& p, Index preferred) const {
  const Vec2 q = frame_.flat(p);
  const double level = glm::dot(p - frame_.origin, frame_.n);
  double best = std::numeric_limits<double>::infinity();
  Place found;
  for (const Index k : grid_[cell(q.y, 1) * count_[0] + cell(q.x, 0)]) {
    const Triangle& t = triangles_[k];
    if (cross2(t.p[1] - t.p[0], t.p[2] - t.p[0]) == 0) continue;
    const Place here = place(t, q);
    const auto& w = here.weights;
    if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
    if (t.face == preferred) return here;
    const double above = w[0] * t.height[0] + w[1] * t.height[1] + w[2] * t.height[2] - level;
    if (std::abs(above) < best) {
      best = std::abs(above);
      found = here;
    }
  }
  if (found.face != kNone) return found;
  for (const Triangle& t : triangles_) {
    const double distance = std::min({squaredDistanceToSegment(q, t.p[0], t.p[1]),
                                      squaredDistanceToSegment(q, t.p[1], t.p[2]),
                                      squaredDistanceToSegment(q, t.p[2], t.p[0])});
    if (distance < best) {
      best = distance;
      found = place(t, q);
    }
  }
  return found;
}

}  // namespace radiosity
