// The smallest angles of a region's triangles, as far as they can be improved.
#pragma once

#include <glm/geometric.hpp>

#include "base/geometry/plane_frame.h"
#include "mesh/cells/region/triangle_shape.h"
#include "mesh/cells/region/triangulated_region.h"

namespace radiosity {

/// Triangles with smaller angles are improved.
inline const AngleLimit kWantedAngle(25.0);

/// Whether a triangle has no area or is turned over, after rounding or a move.
inline bool isTurnedOver(RegionFace f) {
  const Vec2 a = positionOf(f->vertex(0));
  return cross2(positionOf(f->vertex(1)) - a, positionOf(f->vertex(2)) - a) <= 0;
}

/// The smallest angle that inner points and moves can change: angles between two constraints are
/// given.
inline Angle smallestFreeAngle(RegionFace f) {
  const Vec2 p[3] = {positionOf(f->vertex(0)), positionOf(f->vertex(1)), positionOf(f->vertex(2))};
  Angle smallest;
  for (int i = 0; i < 3; ++i) {
    const int next = RegionTriangulation::ccw(i);
    const int last = RegionTriangulation::cw(i);
    if (f->is_constrained(next) && f->is_constrained(last)) continue;
    lower(smallest, {p[next], p[i], p[last]});
  }
  return smallest;
}

/// The smallest free angle of some triangles; less than any angle if a triangle is turned over.
class WorstAngle {
 public:
  void add(RegionFace f) {
    if (turned_over_ || isTurnedOver(f)) {
      turned_over_ = true;
    } else {
      lower(smallest_, smallestFreeAngle(f));
    }
  }
  bool isBelow(const AngleLimit& limit) const { return turned_over_ || limit.isAbove(smallest_); }
  bool isBelow(const WorstAngle& other) const {
    return !other.turned_over_ && (turned_over_ || smallest_.isBelow(other.smallest_));
  }
  /// The angle; -1 if a triangle is turned over.
  double radians() const { return turned_over_ ? -1.0 : smallest_.radians(); }

 private:
  Angle smallest_;
  bool turned_over_ = false;
};

}  // namespace radiosity
