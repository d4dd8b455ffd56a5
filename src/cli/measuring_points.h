// The points that `illuminance` and `heat` measure at.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/illuminance.h"

namespace radiosity::cli {

class Report;

/// A set of points as it was asked for: by --grid, --points or --plane.
struct PointsAsked {
  enum class Kind { grid, points, plane };
  Kind kind = Kind::grid;
  std::string text;
};

/// Checks what needs no scene, so that none is read in vain. Errors: InputError naming the option.
void checkPoints(const PointsAsked& asked);

/// The points: a set each, or of a grid over a pattern of names as many as it has planes. Reports
/// their notes. Errors: InputError naming the option.
std::vector<MeasuringPoints> measuringPoints(std::span<const PointsAsked> asked, const Scene& scene,
                                             Report& report);

/// The points of all sets in turn.
std::vector<Vec3> placesOf(std::span<const MeasuringPoints> sets);

/// Throws InputError for a set that lies outside of the box around the mesh of a closed room: the
/// height is wrong, or a unit.
void requireWithin(std::span<const MeasuringPoints> sets, const PatchMesh& mesh);

/// Throws InputError naming the set, whose points all do that ("lie beyond the room").
[[noreturn]] void refuseSet(const MeasuringPoints& set, const char* where);

}  // namespace radiosity::cli
