// Polygons of a mesh that touch or pass through each other.
#pragma once

#include <span>

#include "base/geometry/box.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Polygons with equal points as one vertex (`first`: from firstAtSamePoint()). What is closer than
/// `coincidence`, metres, touches.
class PolygonContacts {
 public:
  PolygonContacts(std::span<const Vec3> vertices, const PlanarPolygons& polygons,
                  std::span<const Index> first, double coincidence)
      : vertices_(vertices), all_(polygons), first_(first), coincidence_(coincidence) {}

  /// The polygon's box, grown by the coincidence.
  Box3 box(Index p) const;
  /// Whether a point of the polygon's plane is inside it or on its rim.
  bool contains(Index p, const Vec3& point) const;
  /// Whether an edge or corner of p pierces or touches q. Common points do not count.
  bool meets(Index p, Index q) const;
  /// Whether p goes on beyond q: it has parts on both sides of the plane of q, next to a segment
  /// that is in q or on its rim. A common edge alone does not make it so.
  bool passes(Index p, Index q) const;
  /// Whether a segment lies in q, or along its rim, for more than the coincidence.
  bool holds(Index q, const Vec3& from, const Vec3& to) const;
  /// Whether all of p is in the plane of q.
  bool inPlane(Index p, Index q) const;

 private:
  struct Cuts;
  std::span<const Index> loop(std::size_t l) const { return all_.loop(l); }
  std::span<const Index> corners(Index p) const;
  bool hasCorner(Index p, Index vertex) const;
  double height(Index q, const Vec3& point) const;
  int sideOf(Index q, const Vec3& point, double near) const;
  double bend(Index p) const;
  Cuts cutsBy(Index q, Index p, const Vec3& along, double near) const;

  std::span<const Vec3> vertices_;
  const PlanarPolygons& all_;
  std::span<const Index> first_;
  double coincidence_;
};

}  // namespace radiosity
