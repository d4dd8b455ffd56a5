// Regular grids in a plane.
#pragma once

#include <optional>
#include <string>

#include "base/geometry/plane_frame.h"
#include "radiosity/illuminance.h"

namespace radiosity {

/// A rectangle in a frame's plane: two corners, the lower one first.
struct PlaneArea {
  PlaneFrame frame;
  Vec2 low{0.0};
  Vec2 high{0.0};
};

/// 0 for -0, which a report would print.
inline Vec3 withoutMinusZero(const Vec3& v) { return v + Vec3(0.0); }

/// The places of points along a side.
struct GridLine {
  std::size_t count = 0;
  double first = 0;  ///< from the lower end
  double step = 0;
};

/// `step`: between points; none: the standard's for an area of this and the other side. Errors:
/// InputError naming `what` for a step that is no positive number. One longer than the side: a
/// point in its middle.
GridLine gridLine(const std::string& what, double side, double other, std::optional<double> step);

/// Throws InputError naming `what` if there are more points than kMostGridPoints.
void requireFewPoints(const std::string& what, const GridLine& across, const GridLine& along);

}  // namespace radiosity
