#include "formfactor/exact/visibility_shadow.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

void ShadowPlanes::build(const ShapeCorners& light, const Occluder& body, double coincidence) {
  light_ = light;
  coincidence_ = coincidence;
  outside_.clear();
  inside_.clear();
  last_outside_ = last_inside_ = 0;
  may_hide_ = true;
  findFaces(body);
  findSilhouettes(body);
  findTangentsAtEdges(body);
}

/// Which corners of the light are in front of which faces, and what follows from faces alone.
void ShadowPlanes::findFaces(const Occluder& body) {
  front_.resize(body.planes.size());
  unsigned in_front_of_any = 0;
  for (std::size_t p = 0; p < body.planes.size(); ++p) {
    const Occluder::Plane& face = body.planes[p];
    const Plane plane{face.normal.x, face.normal.y, face.normal.z, face.offset, false};
    const std::array<double, 4> h = heights(plane, light_);
    unsigned strict = 0;
    unsigned clear = 0;
    unsigned near = 0;
    for (unsigned i = 0; i < 4; ++i) {
      strict |= unsigned(h[i] > 0) << i;
      clear |= unsigned(h[i] > coincidence_) << i;
      near |= unsigned(h[i] >= -coincidence_) << i;
    }
    front_[p] = std::uint8_t(strict | near << 4);
    in_front_of_any |= near;
    if (near == 15) outside_.push_back(plane);
    if (near != 0) {
      // A shape on the face itself is in plain sight of a light above the face. Where the light
      // only touches the plane, such a shape is no different from one seen edge-on.
      inside_.push_back(plane);
      inside_.back().strictly = clear != 0 || near == 15;
    }
  }
  if (in_front_of_any != 15) may_hide_ = false;  // a corner of the light is inside the body
}

/// Planes through a corner of the light and an edge of the body where faces turn from it.
///
/// Seen from a point in front of the face on its left, an edge has the body on its left, so that
/// cross(edge, point - from) points out of the body.
void ShadowPlanes::findSilhouettes(const Occluder& body) {
  for (const Occluder::Edge& edge : body.edges) {
    const unsigned left = front_[edge.left];
    const unsigned right = front_[edge.right];
    unsigned turns = left ^ right;
    if (turns == 0) continue;
    const Vec3& from = body.corners[edge.from];
    const Vec3 along = body.corners[edge.to] - from;
    const double thinnest = coincidence_ * glm::length(along);
    for (unsigned i = 0; i < 4; ++i) {
      if ((turns >> i & 0x11u) == 0) continue;
      const Vec3 point = light_.at(i);
      const Vec3 cross = glm::cross(along, point - from);
      const double length = glm::length(cross);
      const bool defined = length > thinnest;  // else the point is on the edge's own line
      if ((turns >> i & 1u) != 0 && defined) {
        const Vec3 normal = cross * ((left >> i & 1u) != 0 ? 1 / length : -1 / length);
        const Plane plane = makePlane(normal, point);
        const std::array<double, 4> h = heights(plane, light_);
        if (*std::min_element(h.begin(), h.end()) >= -coincidence_) outside_.push_back(plane);
      }
      if ((turns >> i & 0x10u) != 0) {
        if (!defined) {
          may_hide_ = false;
          continue;
        }
        const Vec3 normal = cross * ((left >> i & 0x10u) != 0 ? 1 / length : -1 / length);
        inside_.push_back(makePlane(normal, point));
      }
    }
  }
}

/// Planes through an edge of the light that touch the body and leave it and the light on
/// different sides: turned about the edge until no corner of the body is above.
void ShadowPlanes::findTangentsAtEdges(const Occluder& body) {
  for (unsigned i = 0; i < 4; ++i) {
    const Vec3 point = light_.at(i);
    const Vec3 along = light_.at((i + 1) % 4) - point;
    if (along == Vec3(0.0)) continue;  // a triangle
    for (const double sense : {1.0, -1.0}) {
      const Vec3 axis = sense * along;
      Vec3 normal(0.0);
      for (const Vec3& corner : body.corners) {
        const Vec3 arm = corner - point;
        if (normal == Vec3(0.0) || glm::dot(normal, arm) > 0) normal = glm::cross(axis, arm);
      }
      const double length = glm::length(normal);
      if (!(length > coincidence_ * glm::length(along))) continue;
      const Plane plane = makePlane(normal * (1 / length), point);
      const std::array<double, 4> h = heights(plane, light_);
      if (*std::min_element(h.begin(), h.end()) < -coincidence_) continue;
      // Where the edge's line meets the body, turning finds no end.
      const bool below = std::all_of(body.corners.begin(), body.corners.end(), [&](const Vec3& c) {
        return plane.x * c.x + plane.y * c.y + plane.z * c.z - plane.offset <= coincidence_;
      });
      if (below) outside_.push_back(plane);
    }
  }
}

bool ShadowPlanes::separates(const ShapeCorners& shape, Planes& open) {
  constexpr std::size_t kLastBit = 63;
  const auto above = [&](std::size_t p) {
    const std::array<double, 4> h = heights(outside_[p], shape);
    unsigned count = 0;
    for (const double height : h) count += unsigned(height >= -coincidence_);
    return count;
  };
  for (std::size_t tail = kLastBit; tail < outside_.size(); ++tail) {
    if (above(tail) == 4) return true;
  }
  const std::size_t count = std::min(outside_.size(), kLastBit);
  if (last_outside_ < count && (open >> last_outside_ & 1) != 0) {
    if (above(last_outside_) == 4) return true;
  }
  Planes left = open & ((Planes(1) << count) - 1);
  while (left != 0) {
    const auto p = std::size_t(std::countr_zero(left));
    left &= left - 1;
    const unsigned corners = above(p);
    if (corners == 4) {
      last_outside_ = p;
      return true;
    }
    if (corners == 0) open &= ~(Planes(1) << p);
  }
  return false;
}

bool ShadowPlanes::hides(const ShapeCorners& shape) {
  if (!may_hide_) return false;
  const std::size_t count = inside_.size();
  for (std::size_t k = 0, p = last_inside_; k < count; ++k, ++p) {
    if (p >= count) p = 0;
    const std::array<double, 4> h = heights(inside_[p], shape);
    const double highest = std::max(std::max(h[0], h[1]), std::max(h[2], h[3]));
    const double lowest = std::min(std::min(h[0], h[1]), std::min(h[2], h[3]));
    if (highest > coincidence_ || (inside_[p].strictly && lowest >= -coincidence_)) {
      last_inside_ = p;
      return false;
    }
  }
  return true;
}

ShadowRelation ShadowPlanes::relation(const ShapeCorners& shape, Planes& open) {
  if (separates(shape, open)) return ShadowRelation::kOutside;
  return hides(shape) ? ShadowRelation::kInside : ShadowRelation::kUnclear;
}

}  // namespace radiosity
