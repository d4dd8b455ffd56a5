// The points that `illuminance` measures at.
#pragma once

#include <string>
#include <vector>

#include "radiosity/illuminance.h"

namespace radiosity::cli {

/// A set of points as it was asked for: by --grid, --points or --plane.
struct PointsAsked {
  enum class Kind { grid, points, plane };
  Kind kind = Kind::grid;
  std::string text;
};

/// Checks what needs no scene, so that none is read in vain. Errors: InputError naming the option.
void checkPoints(const PointsAsked& asked);

/// The points: one set, or of a grid over a pattern of names as many as it has planes. Errors:
/// InputError naming the option.
std::vector<MeasuringPoints> pointsOf(const PointsAsked& asked, const Scene& scene);

}  // namespace radiosity::cli
