// The space between two polygons, and its possible blockers.
#pragma once

#include <vector>

#include "loop.h"

namespace radiosity::truth {

/// A convex polygon with its plane.
struct Sheet {
  Loop loop;
  Vec3 normal{0.0};  ///< unit, the loop is counter-clockwise about it
  double offset = 0;
  Vec3 middle{0.0};
  double radius = 0;
  explicit Sheet(const Loop& corners);
  /// A part of another sheet, however small: its plane is the other's.
  Sheet(const Loop& corners, const Sheet& part_of);
};

/// A convex piece of a planar polygon, as an obstacle.
struct Blocker : Sheet {
  using Sheet::Sheet;
  Index body = 0;  ///< pieces that share corners, directly or through others, are one body
  /// The body is closed and convex, fronts outward, with no vertex of the scene inside: from
  /// anywhere else each line that meets it meets a front first, so that backs need no look.
  bool solid = false;
};

/// Planes that have both sheets on one side: a body without a point beyond any one of them is
/// outside the convex hull of the two, and cannot come between. Touching counts as outside: within
/// `coincidence` for the sheets' own planes, within rounding for the others.
class Shaft {
 public:
  Shaft(const Sheet& a, const Sheet& b, double coincidence);

  /// False: it cuts no line from a to b. True: it may.
  bool mayBlock(const Blocker& blocker) const;

  /// The same, true only if it does: the hull of the sheets and the blocker have no plane between
  /// them (separating axes: faces of either, and an edge of one by an edge of the other).
  bool blocks(const Blocker& blocker) const;

  /// The same for everything inside a box.
  bool mayBlock(const Vec3& low, const Vec3& high) const;

 private:
  struct Plane {
    Vec3 normal;
    double offset;  ///< dot(normal, x) > offset where something may block
  };
  bool separates(const Vec3& axis, const Loop& loop) const;
  void addSupports(const Loop& edges, const Loop& points, double slack);

  const Sheet& a_;
  const Sheet& b_;
  double coincidence_;
  std::vector<Plane> planes_;
};

}  // namespace radiosity::truth
