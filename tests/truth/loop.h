// Planar convex polygons of few corners, and cutting them by planes. Part of the ground truth,
// which shares no code with the engine it judges.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/geometric.hpp>
#include <span>
#include <stdexcept>

#include "radiosity/base.h"

namespace radiosity::truth {

/// A convex planar polygon without allocation. Cutting by a plane adds at most one corner; a
/// polygon that would need more corners than there is room for is an error, never a silent loss.
template <class Point>
class BasicLoop {
 public:
  static constexpr std::size_t kRoom = 40;

  BasicLoop() = default;
  template <class Other>
  explicit BasicLoop(std::span<const Other> points) {
    for (const Other& p : points) push(Point(p));
  }

  void push(const Point& p) {
    if (size_ == kRoom) throw std::length_error("ground truth: a polygon of more than 40 corners");
    points_[size_++] = p;
  }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  const Point& operator[](std::size_t k) const { return points_[k]; }
  Point& operator[](std::size_t k) { return points_[k]; }
  const Point& next(std::size_t k) const { return points_[k + 1 == size_ ? 0 : k + 1]; }
  const Point* begin() const { return points_.data(); }
  const Point* end() const { return points_.data() + size_; }

 private:
  std::array<Point, kRoom> points_;
  std::size_t size_ = 0;
};

using Loop = BasicLoop<Vec3>;

/// Twice the vector area: along the normal a loop is counter-clockwise about.
template <class Point>
Point vectorArea(const BasicLoop<Point>& loop) {
  Point sum(0);
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    sum += glm::cross(loop[k] - loop[0], loop[k + 1] - loop[0]);
  }
  return sum;
}

/// Splits a loop by the plane dot(normal, x) = offset into what lies above and below. Corners
/// within `slack` of the plane count as on it and go to both sides; a side without a corner
/// beyond the slack comes out empty. Either result may be null.
template <class Point, class Real>
void split(const BasicLoop<Point>& loop, const Point& normal, Real offset, Real slack,
           BasicLoop<Point>* above, BasicLoop<Point>* below) {
  std::array<Real, BasicLoop<Point>::kRoom> height;
  bool any_above = false;
  bool any_below = false;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    height[k] = glm::dot(normal, loop[k]) - offset;
    if (height[k] > slack) {
      any_above = true;
    } else if (height[k] < -slack) {
      any_below = true;
    } else {
      height[k] = 0;
    }
  }
  if (above) above->clear();
  if (below) below->clear();
  if (!any_above || !any_below) {
    if (above && any_above) *above = loop;
    if (below && any_below) *below = loop;
    return;
  }
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const std::size_t next = k + 1 == loop.size() ? 0 : k + 1;
    if (above && height[k] >= 0) above->push(loop[k]);
    if (below && height[k] <= 0) below->push(loop[k]);
    if ((height[k] > 0 && height[next] < 0) || (height[k] < 0 && height[next] > 0)) {
      const Point cut = loop[k] + (loop[next] - loop[k]) * (height[k] / (height[k] - height[next]));
      if (above) above->push(cut);
      if (below) below->push(cut);
    }
  }
}

/// Centre of a loop's corners.
inline Vec3 middleOf(const Loop& loop) {
  Vec3 sum(0.0);
  for (const Vec3& p : loop) sum += p;
  return sum / double(loop.size());
}

/// Largest distance of a corner from `centre`.
inline double reach(const Loop& loop, const Vec3& centre) {
  double far = 0;
  for (const Vec3& p : loop) far = std::max(far, glm::distance(p, centre));
  return far;
}

}  // namespace radiosity::truth
