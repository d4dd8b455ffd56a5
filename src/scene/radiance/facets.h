// Flat faces in place of curved surfaces.
#pragma once

#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// Faces in place of a curved surface: planar, convex, counter-clockwise seen from its front.
struct Facets {
  std::vector<Vec3> vertices;
  std::vector<std::vector<Index>> faces;
  double off = 0;   ///< the farthest that a point of them lies off the surface, over its radius
  double area = 1;  ///< theirs over that of the surface

  void turnOver();
};

// `tolerance`: the most that `off` may be. Circles become polygons of the same area, the corners of
// which lie outside; those of one axis and radius meet, whatever they belong to.

/// Facing outward, in meridians and parallels, of the area of the sphere.
Facets sphereFacets(const Vec3& centre, double radius, double tolerance);
/// A cone between two circles about the way from `a` to `b`, without these ends, facing outward; a
/// cylinder if the radii are equal. One of them may be 0.
Facets coneFacets(const Vec3& a, double radius_a, const Vec3& b, double radius_b, double tolerance);
/// A ring between two circles, or a disc if `inner` is 0, of its area, facing `normal` (unit).
Facets ringFacets(const Vec3& centre, const Vec3& normal, double inner, double outer,
                  double tolerance);

}  // namespace radiosity
