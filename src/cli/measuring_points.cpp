#include "cli/measuring_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/figure_text.h"
#include "base/geometry/box.h"
#include "base/parse.h"
#include "cli/report.h"

namespace radiosity::cli {

namespace {

/// SURFACE[:HEIGHT[:SPACING]]. A name may have colons: only numbers at the end are none of it.
struct GridText {
  std::string surface;
  double height = 0;
  std::optional<double> spacing;
};

GridText parseGrid(const std::string& text) {
  GridText grid{text, 0, {}};
  std::vector<double> numbers;  // from the end
  while (numbers.size() < 2) {
    const std::size_t colon = grid.surface.rfind(':');
    if (colon == std::string::npos || colon == 0) break;
    const std::optional<double> number = parseNumber(grid.surface.substr(colon + 1));
    if (!number) break;
    numbers.push_back(*number);
    grid.surface.resize(colon);
  }
  if (!numbers.empty()) grid.height = numbers.back();
  if (numbers.size() == 2) grid.spacing = numbers.front();
  if (grid.surface.empty()) {
    throw InputError("--grid: no surface is named; give SURFACE[:HEIGHT[:SPACING]], e.g. floor:.8");
  }
  return grid;
}

struct PlaneText {
  std::array<Vec3, 3> corners{};
  std::optional<double> spacing;
};

PlaneText parsePlane(const std::string& text) {
  const std::vector<std::string_view> parts = splitAt(text, ':');
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format(
        "--plane: {}; give three corners in turn, X,Y,Z:X,Y,Z:X,Y,Z in metres, and perhaps "
        ":SPACING",
        what));
  };
  if (parts.size() != 3 && parts.size() != 4) {
    fail(fmt::format("'{}' has {} parts", text, parts.size()));
  }
  PlaneText plane;
  for (std::size_t k = 0; k < 3; ++k) {
    if (const std::optional<Vec3> corner = parseTriple(parts[k])) {
      plane.corners[k] = *corner;
    } else {
      fail(fmt::format("'{}' is no corner", parts[k]));
    }
  }
  if (parts.size() == 4) {
    plane.spacing = parseNumber(parts[3]);
    if (!plane.spacing) fail(fmt::format("'{}' is no spacing", parts[3]));
  }
  return plane;
}

std::vector<MeasuringPoints> pointsOf(const PointsAsked& asked, const Scene& scene) {
  switch (asked.kind) {
    case PointsAsked::Kind::grid: {
      const GridText grid = parseGrid(asked.text);
      return pointsOverSurfaces(scene, grid.surface, grid.height, grid.spacing);
    }
    case PointsAsked::Kind::plane: {
      const PlaneText plane = parsePlane(asked.text);
      return {pointsOnPlane(plane.corners, plane.spacing)};
    }
    case PointsAsked::Kind::points:
      break;
  }
  return {readMeasuringPoints(asked.text, scene.up)};
}

/// Whether all points lie outside of the box around the room.
bool isBeyond(const MeasuringPoints& set, const PatchMesh& mesh) {
  constexpr double kRounding = 1e-6;
  const Box3 room = boxOf(mesh.vertices);
  const Box3 around = room.grown(kRounding * room.diagonal());
  return std::ranges::none_of(set.at, [&](const Vec3& p) { return around.contains(p); });
}

}  // namespace

void checkPoints(const PointsAsked& asked) {
  switch (asked.kind) {
    case PointsAsked::Kind::grid:
      parseGrid(asked.text);
      return;
    case PointsAsked::Kind::plane: {
      const PlaneText plane = parsePlane(asked.text);
      pointsOnPlane(plane.corners, plane.spacing);
      return;
    }
    case PointsAsked::Kind::points:
      readMeasuringPoints(asked.text, Up::y);
  }
}

std::vector<MeasuringPoints> measuringPoints(std::span<const PointsAsked> asked, const Scene& scene,
                                             Report& report) {
  std::vector<MeasuringPoints> sets;
  for (const PointsAsked& one : asked) {
    for (MeasuringPoints& set : pointsOf(one, scene)) {
      report.notes(set.notes);
      sets.push_back(std::move(set));
    }
  }
  return sets;
}

std::vector<Vec3> placesOf(std::span<const MeasuringPoints> sets) {
  std::vector<Vec3> at;
  for (const MeasuringPoints& set : sets) at.insert(at.end(), set.at.begin(), set.at.end());
  return at;
}

void requireWithin(std::span<const MeasuringPoints> sets, const PatchMesh& mesh) {
  for (const MeasuringPoints& set : sets) {
    if (isBeyond(set, mesh)) refuseSet(set, "lie beyond the room");
  }
}

void refuseSet(const MeasuringPoints& set, const char* where) {
  throw InputError(
      fmt::format("{}: all of its {} points {}; check the height and the unit of the "
                  "scene (metres here)",
                  set.name, countText(set.size()), where));
}

}  // namespace radiosity::cli
