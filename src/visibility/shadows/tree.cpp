#include "visibility/shadows/tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "base/geometry/box.h"

namespace radiosity {

/// The hull is the union of spheres whose centres and radii run linearly from a to b. The gap to a
/// ball at axial place x and distance y from the axis, sqrt((x - t d)^2 + y^2) - r(t), is convex in
/// t; with s = (r_b - r_a)/d it is least where t d - x = y s / sqrt(1 - s^2).
SphereHull::SphereHull(const Sphere& a, const Sphere& b)
    : start_(a.centre), axis_(b.centre - a.centre), radius_(a.radius), slope_(b.radius - a.radius) {
  const double square = glm::dot(axis_, axis_);
  if (square > slope_ * slope_) {
    square_ = square;
    inverse_square_ = 1 / square;
    tilt_ = slope_ / std::sqrt(square - slope_ * slope_);
  } else if (slope_ > 0) {
    start_ = b.centre;
    radius_ = b.radius;
  }
}

bool SphereHull::meets(const Sphere& ball) const {
  const Vec3 arm = ball.centre - start_;
  const double arm_square = glm::dot(arm, arm);
  if (square_ == 0) {
    const double reach = radius_ + ball.radius;
    return arm_square <= reach * reach;
  }
  const double along = glm::dot(arm, axis_);
  const double across_square = std::max(0.0, arm_square * square_ - along * along);
  const double t = (along + std::sqrt(across_square) * tilt_) * inverse_square_;
  const double at = std::clamp(t, 0.0, 1.0);
  const Vec3 gap = arm - at * axis_;
  const double reach = radius_ + at * slope_ + ball.radius;
  return glm::dot(gap, gap) <= reach * reach;
}

OccluderTree::OccluderTree(const std::vector<Occluder>& occluders)
    : occluders_(occluders), order_(occluders.size()) {
  std::iota(order_.begin(), order_.end(), Index(0));
  if (occluders.empty()) return;
  nodes_.reserve(2 * occluders.size());
  nodes_.emplace_back();
  build(0, 0, Index(order_.size()));
}

void OccluderTree::build(Index node, Index first, Index count) {
  Box3 box;
  for (Index k = first; k < first + count; ++k) {
    const Occluder& occluder = occluders_[order_[k]];
    box.add(occluder.centre - Vec3(occluder.radius));
    box.add(occluder.centre + Vec3(occluder.radius));
  }
  Sphere bound{box.centre(), 0};
  for (Index k = first; k < first + count; ++k) {
    const Occluder& occluder = occluders_[order_[k]];
    for (const Vec3& corner : occluder.corners) {
      bound.radius = std::max(bound.radius, glm::distance(corner, bound.centre));
    }
  }
  nodes_[node].bound = bound;
  if (count <= 2) {
    nodes_[node].first = first;
    nodes_[node].count = count;
    return;
  }
  const int axis = box.longestAxis();
  const Index half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half,
                   order_.begin() + first + count, [&](Index a, Index b) {
                     const double ca = occluders_[a].centre[axis];
                     const double cb = occluders_[b].centre[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  const Index child = Index(nodes_.size());
  nodes_[node].first = child;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(child, first, half);
  build(child + 1, first + half, count - half);
}

void OccluderTree::query(const Sphere& a, const Sphere& b, const HalfSpace& front_of_a,
                         const HalfSpace& front_of_b, std::vector<Index>& found, std::size_t& tests,
                         std::size_t most) const {
  if (nodes_.empty()) return;
  const SphereHull hull(a, b);
  const auto reaches = [&](const Sphere& ball) {
    ++tests;
    return glm::dot(front_of_a.normal, ball.centre) + ball.radius > front_of_a.offset &&
           glm::dot(front_of_b.normal, ball.centre) + ball.radius > front_of_b.offset &&
           hull.meets(ball);
  };
  const auto above = [](const Occluder& occluder, const HalfSpace& space) {
    return std::any_of(occluder.corners.begin(), occluder.corners.end(),
                       [&](const Vec3& c) { return glm::dot(space.normal, c) > space.offset; });
  };
  Index stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0 && found.size() <= most) {
    const Node& node = nodes_[stack[--depth]];
    if (!reaches(node.bound)) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = node.first + 1;
      continue;
    }
    for (Index k = node.first; k < node.first + node.count; ++k) {
      const Occluder& occluder = occluders_[order_[k]];
      if (node.count > 1 && !reaches({occluder.centre, occluder.radius})) continue;
      if (above(occluder, front_of_a) && above(occluder, front_of_b)) found.push_back(order_[k]);
    }
  }
}

}  // namespace radiosity
