#include "visibility/shadows/shadow.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

namespace {

ShadowPlane makePlane(const Vec3& normal, const Vec3& point) {
  return {normal.x, normal.y, normal.z, glm::dot(normal, point)};
}

std::array<double, 4> heights(const ShadowPlane& plane, const ShapeCorners& shape) {
  std::array<double, 4> h;
  for (std::size_t k = 0; k < 4; ++k) {
    h[k] = plane.x * shape.x[k] + plane.y * shape.y[k] + plane.z * shape.z[k] - plane.offset;
  }
  return h;
}

}  // namespace

void ShadowPlanes::build(const ShapeCorners& light, const Occluder& body, double coincidence) {
  light_ = light;
  coincidence_ = coincidence;
  outside_.clear();
  inside_.clear();
  strictly_.clear();
  last_outside_ = last_inside_ = 0;
  may_hide_ = true;
  findFaces(body);
  findSilhouettes(body);
  findTangentsAtEdges(body);
}

/// Finds which corners of the light are in front of which faces, and the planes of faces alone.
void ShadowPlanes::findFaces(const Occluder& body) {
  front_.resize(body.planes.size());
  unsigned in_front_of_any = 0;
  for (std::size_t p = 0; p < body.planes.size(); ++p) {
    const Occluder::Plane& face = body.planes[p];
    const ShadowPlane plane{face.normal.x, face.normal.y, face.normal.z, face.offset};
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
      if (clear != 0 || near == 15) strictly_.push_back(Index(inside_.size()));
      inside_.push_back(plane);
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
        const ShadowPlane plane = makePlane(normal, point);
        if (isAbove(plane)) outside_.push_back(plane);
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
      const ShadowPlane plane = makePlane(normal * (1 / length), point);
      if (!isAbove(plane)) continue;
      // If the edge's line meets the body, turning finds no end.
      const bool below = std::all_of(body.corners.begin(), body.corners.end(), [&](const Vec3& c) {
        return plane.x * c.x + plane.y * c.y + plane.z * c.z - plane.offset <= coincidence_;
      });
      if (below) outside_.push_back(plane);
    }
  }
}

/// True if the light is above a plane, or on it.
bool ShadowPlanes::isAbove(const ShadowPlane& plane) const {
  const std::array<double, 4> h = heights(plane, light_);
  return h[0] >= -coincidence_ && h[1] >= -coincidence_ && h[2] >= -coincidence_ &&
         h[3] >= -coincidence_;
}

bool ShadowPlanes::separates(const VisibilityKernels& kernels, const ShapeCorners& shape,
                             Planes& open) {
  Planes below = 0;
  const Planes last = open & Planes(1) << last_outside_;
  if (last != 0 && last_outside_ < outside_.size()) {
    if (kernels.findAbove(outside_.data(), last, shape, -coincidence_, below) != kPlaneBits) {
      return true;
    }
    open &= ~below;
  }
  for (std::size_t first = 0; first < outside_.size(); first += kPlaneBits) {
    const std::size_t count = outside_.size() - first;
    Planes tried = first == 0 ? open : kAllPlanes;
    if (count < kPlaneBits) tried &= (Planes(1) << count) - 1;
    const std::size_t p =
        kernels.findAbove(outside_.data() + first, tried, shape, -coincidence_, below);
    if (p != kPlaneBits) {
      if (first == 0) last_outside_ = p;
      return true;
    }
    if (first == 0) open &= ~below;
  }
  return false;
}

bool ShadowPlanes::hides(const VisibilityKernels& kernels, const ShapeCorners& shape) {
  if (!may_hide_) return false;
  const std::size_t crossed =
      kernels.findCrossed(inside_.data(), inside_.size(), last_inside_, shape, coincidence_);
  if (crossed != inside_.size()) {
    last_inside_ = crossed;
    return false;
  }
  return std::all_of(strictly_.begin(), strictly_.end(), [&](Index p) {
    const std::array<double, 4> h = heights(inside_[p], shape);
    return *std::min_element(h.begin(), h.end()) < -coincidence_;
  });
}

ShadowRelation ShadowPlanes::relation(const VisibilityKernels& kernels, const ShapeCorners& shape,
                                      Planes& open) {
  if (separates(kernels, shape, open)) return ShadowRelation::kOutside;
  return hides(kernels, shape) ? ShadowRelation::kInside : ShadowRelation::kUnclear;
}

}  // namespace radiosity
