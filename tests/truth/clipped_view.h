// A point's view of a polygon past others, by exact clipping.
#pragma once

#include <vector>

#include "shaft.h"

namespace radiosity::truth {

/// Form factor from a differential element at the origin with unit normal `normal` to a polygon
/// above its horizon, positive where the polygon's front faces it (Lambert; Baum et al. 1989,
/// eq. 9, with the sign of a polygon counter-clockwise about its own normal).
double pointToPolygon(const Loop& polygon, const Vec3& normal);

/// One point's view of the target.
struct Glimpse {
  double whole = 0;     ///< form factor to the target without blockers
  double blocked = 0;   ///< the part of it that blockers take away
  bool clear = false;   ///< no blocker touches it: blocked is 0 exactly
  bool hidden = false;  ///< nothing is left of it
};

/// A target behind blockers, seen from points of the sheet it was made for.
class ClippedView {
 public:
  /// `target` in front of `source`'s plane. All are kept by reference.
  ClippedView(const Sheet& source, const Loop& target, const std::vector<const Blocker*>& blockers)
      : source_(source), target_(target), blockers_(blockers) {}

  /// From a point of the source. Each blocker's shadow is the cone over it, cut off by its own
  /// plane; the target minus one shadow after the other is a list of convex pieces.
  Glimpse from(const Vec3& point) const;

 private:
  const Sheet& source_;
  const Loop& target_;
  const std::vector<const Blocker*>& blockers_;
};

}  // namespace radiosity::truth
