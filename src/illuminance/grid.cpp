#include "illuminance/grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/figure_text.h"
#include "base/finite.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

/// A side of whole steps, but for rounding.
constexpr double kWhole = 1e-9;

}  // namespace

double standardSpacing(double longer, double shorter) {
  constexpr double kLargest = 10;
  const double d = longer >= 2 * shorter ? shorter : longer;
  return std::min(kLargest, 0.2 * std::pow(5.0, std::log10(d)));
}

GridLine gridLine(const std::string& what, double side, double other, std::optional<double> step) {
  GridLine line;
  if (!step) {
    const double standard = standardSpacing(std::max(side, other), std::min(side, other));
    line.count = std::size_t(std::clamp(std::round(side / standard), 1.0, 1e9));
    line.step = side / double(line.count);
    line.first = 0.5 * line.step;
    return line;
  }
  if (!std::isfinite(*step) || !(*step > 0)) {
    throw InputError(
        fmt::format("{}: a spacing of {} m is no distance; give one above 0", what, *step));
  }
  // The border is half a step at least.
  line.count = std::size_t(std::clamp(std::floor(side / *step + kWhole), 1.0, 1e9));
  line.step = *step;
  line.first = 0.5 * (side - double(line.count - 1) * *step);
  return line;
}

void requireFewPoints(const std::string& what, const GridLine& across, const GridLine& along) {
  const double points = double(across.count) * double(along.count);
  if (points <= double(kMostGridPoints)) return;
  throw InputError(
      fmt::format("{}: a spacing of {:.6g} m makes {:.3g} points; at most {} are "
                  "evaluated: give a larger one",
                  what, across.step, points, countText(kMostGridPoints)));
}

MeasuringPoints pointsOnPlane(const std::array<Vec3, 3>& corners, std::optional<double> spacing) {
  for (const Vec3& corner : corners) {
    if (!isFinite(corner)) throw InputError("plane: a corner is no place; give finite numbers");
  }
  const Vec3 across = corners[1] - corners[0];
  const Vec3 along = corners[2] - corners[1];
  const Vec3 normal = glm::cross(across, along);
  const double width = glm::length(across);
  const double height = glm::length(along);
  constexpr double kLeastSine = 1e-9;
  if (!(glm::length(normal) > kLeastSine * width * height)) {
    throw InputError(
        "plane: the three corners are in one line; give three corners of a parallelogram in turn");
  }
  const std::string what = "plane";
  const GridLine columns = gridLine(what, width, height, spacing);
  const GridLine rows = gridLine(what, height, width, spacing);
  requireFewPoints(what, columns, rows);
  MeasuringPoints out;
  out.name = "plane";
  const Vec3 u = across / width;
  const Vec3 v = along / height;
  MeasuringPoints::Grid grid{.first = corners[0] + columns.first * u + rows.first * v,
                             .u = u,
                             .v = v,
                             .step_u = columns.step,
                             .step_v = rows.step,
                             .columns = columns.count,
                             .rows = rows.count};
  for (std::size_t row = 0; row < rows.count; ++row) {
    for (std::size_t column = 0; column < columns.count; ++column) {
      out.at.push_back(grid.first + double(column) * columns.step * u +
                       double(row) * rows.step * v);
      out.cell.push_back(row * columns.count + column);
    }
  }
  out.normal.assign(out.at.size(), withoutMinusZero(glm::normalize(normal)));
  out.grid = grid;
  return out;
}

}  // namespace radiosity
