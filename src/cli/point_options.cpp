// Options of the points that `illuminance` and `heat` measure at.
#include <CLI/CLI.hpp>

#include "cli/options.h"

namespace radiosity::cli {

namespace {

void addPoints(CLI::App& app, Request& r, const char* option, PointsAsked::Kind kind,
               const char* value, const char* help) {
  app.add_option_function<std::vector<std::string>>(
         option,
         [&r, kind](const std::vector<std::string>& texts) {
           for (const std::string& text : texts) r.points.push_back({kind, text});
         },
         help)
      ->group("Points")
      ->option_text(value)
      ->allow_extra_args(false);
}

}  // namespace

void addPointOptions(CLI::App& app, Request& r) {
  addPoints(
      app, r, "--grid", PointsAsked::Kind::grid, "SURFACE[:HEIGHT[:SPACING]]",
      "A grid over a planar surface (or object, or material), HEIGHT metres above it along its "
      "normal (default 0; below 0: over its other side), SPACING metres apart (default: that "
      "of EN 12464-1, .2 * 5^lg(longer side), with borders of half of it). Of a surface that "
      "is not planar, and of a thin board, the faces that face up. A pattern of surfaces in "
      "several planes has a grid for each. May be repeated, as the next two");
  addPoints(app, r, "--plane", PointsAsked::Kind::plane, "X,Y,Z:X,Y,Z:X,Y,Z[:SPACING]",
            "A grid on a parallelogram by three corners in turn, metres; it faces the side from "
            "which they are counter-clockwise");
  addPoints(app, r, "--points", PointsAsked::Kind::points, "FILE.csv",
            "Points from a table: x,y,z in metres and, where they do not face up, nx,ny,nz");
}

}  // namespace radiosity::cli
