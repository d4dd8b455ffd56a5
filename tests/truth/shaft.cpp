#include "shaft.h"

#include <initializer_list>
#include <limits>
#include <utility>

namespace radiosity::truth {
namespace {

/// Of the coincidence: rounding of coordinates of the scene's size.
constexpr double kRounding = 1e-6;

bool allBelow(const Loop& loop, const Vec3& normal, double offset, double slack) {
  return std::all_of(loop.begin(), loop.end(),
                     [&](const Vec3& p) { return glm::dot(normal, p) - offset <= slack; });
}

}  // namespace

Sheet::Sheet(const Loop& corners)
    : loop(corners), normal(glm::normalize(vectorArea(corners))), middle(middleOf(corners)) {
  offset = glm::dot(normal, middle);
  radius = reach(loop, middle);
}

Sheet::Sheet(const Loop& corners, const Sheet& part_of)
    : loop(corners), normal(part_of.normal), offset(part_of.offset), middle(middleOf(corners)) {
  radius = reach(loop, middle);
}

Shaft::Shaft(const Sheet& a, const Sheet& b, double coincidence)
    : a_(a),
      b_(b),
      coincidence_(coincidence),
      planes_{{a.normal, a.offset + coincidence}, {b.normal, b.offset + coincidence}} {
  const double slack = kRounding * coincidence;
  addSupports(a.loop, b.loop, slack);
  addSupports(b.loop, a.loop, slack);
}

/// Planes through an edge of one and a corner of the other that have both on one side.
void Shaft::addSupports(const Loop& edges, const Loop& points, double slack) {
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const Vec3 along = edges.next(k) - edges[k];
    for (const Vec3& p : points) {
      Vec3 normal = glm::cross(along, p - edges[k]);
      const double length = glm::length(normal);
      if (!(length > 1e-9 * glm::length(along) * glm::distance(p, edges[k]))) continue;
      normal /= length;
      const double offset = glm::dot(normal, edges[k]);
      for (const double side : {1.0, -1.0}) {
        if (allBelow(edges, side * normal, side * offset, slack) &&
            allBelow(points, side * normal, side * offset, slack)) {
          planes_.push_back({-side * normal, -side * offset + slack});
        }
      }
    }
  }
}

bool Shaft::mayBlock(const Blocker& blocker) const {
  for (const Plane& plane : planes_) {
    if (allBelow(blocker.loop, plane.normal, plane.offset, 0.0)) return false;
  }
  // Nothing gets across a plane that has both ends on one side.
  const auto below = [&](const Vec3& normal, double offset) {
    return allBelow(a_.loop, normal, offset, coincidence_) &&
           allBelow(b_.loop, normal, offset, coincidence_);
  };
  return !below(blocker.normal, blocker.offset) && !below(-blocker.normal, -blocker.offset);
}

bool Shaft::blocks(const Blocker& blocker) const {
  if (!mayBlock(blocker)) return false;
  std::vector<Vec3> edges;
  for (const Loop* loop : {&a_.loop, &b_.loop}) {
    for (std::size_t k = 0; k < loop->size(); ++k) edges.push_back(loop->next(k) - (*loop)[k]);
  }
  for (const Vec3& p : a_.loop) {
    for (const Vec3& q : b_.loop) edges.push_back(q - p);
  }
  for (std::size_t k = 0; k < blocker.loop.size(); ++k) {
    const Vec3 along = blocker.loop.next(k) - blocker.loop[k];
    for (const Vec3& edge : edges) {
      if (separates(glm::cross(edge, along), blocker.loop)) return false;
    }
  }
  return true;
}

bool Shaft::separates(const Vec3& axis, const Loop& loop) const {
  const double length = glm::length(axis);
  if (!(length > 0)) return false;
  const auto range = [&](std::initializer_list<const Loop*> loops) {
    double low = std::numeric_limits<double>::max();
    double high = -low;
    for (const Loop* one : loops) {
      for (const Vec3& p : *one) {
        low = std::min(low, glm::dot(axis, p));
        high = std::max(high, glm::dot(axis, p));
      }
    }
    return std::pair(low, high);
  };
  const auto [low, high] = range({&loop});
  const auto [from, to] = range({&a_.loop, &b_.loop});
  const double slack = kRounding * coincidence_ * length;
  return high <= from + slack || low >= to - slack;
}

bool Shaft::mayBlock(const Vec3& low, const Vec3& high) const {
  return std::all_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
    double most = -plane.offset;
    for (int axis = 0; axis < 3; ++axis) {
      const double n = plane.normal[axis];
      most += n * (n > 0 ? high : low)[axis];
    }
    return most > 0;
  });
}

}  // namespace radiosity::truth
