// Pairs of polygons whose form factor is known in closed form, and plates with an obstacle between.
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/mesh_builder.h"

namespace radiosity::truth {

using Corners = std::vector<Vec3>;

/// F from one polygon to the other, each facing the side it is counter-clockwise from.
struct ClosedForm {
  std::string name;
  Corners from, to;
  double f;
};

/// A rectangle [x0, x1] x [y0, y1] at height z facing up, or down.
inline Corners level(double x0, double x1, double y0, double y1, double z, bool up) {
  if (up) return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
  return {{x0, y0, z}, {x0, y1, z}, {x1, y1, z}, {x1, y0, z}};
}

/// A rectangle at x facing +x.
inline Corners upright(double x, double y0, double y1, double z0, double z1) {
  return {{x, y0, z0}, {x, y1, z0}, {x, y1, z1}, {x, y0, z1}};
}

/// Parallel rectangles (Howell C-11), perpendicular ones with a common edge (C-14), unit squares at
/// an angle (C-16), offset and corner-touching squares, right triangles and the faces of a regular
/// tetrahedron and octahedron: 12 digits or more, the latter ones by contour integrals evaluated to
/// 20 digits by two routes.
inline std::vector<ClosedForm> closedForms() {
  std::vector<ClosedForm> forms;
  const auto parallel = [&](double a, double b, double c, double f) {
    forms.push_back({"parallel " + std::to_string(a) + " " + std::to_string(c),
                     level(0, a, 0, b, 0, true), level(0, a, 0, b, c, false), f});
  };
  parallel(1, 1, 1, 0.199824895698387);
  parallel(1, 1, 0.01, 0.980416602925973);
  parallel(1, 1, 0.1, 0.826994522397257);
  parallel(1, 1, 0.5, 0.415253283577147);
  parallel(1, 1, 2, 0.0685895888185524);
  parallel(1, 1, 5, 0.0124039773132451);
  parallel(1, 1, 10, 0.00316205683875760);
  parallel(2, 1, 1, 0.285875384850715);
  parallel(4, 1, 1, 0.345961460677693);

  const auto hinged = [&](double w, double h, double l, double degrees, double f) {
    const double angle = degrees * std::numbers::pi / 180;
    const Vec3 up = degrees == 90 ? Vec3(0, 0, h) : Vec3(std::cos(angle), 0, std::sin(angle)) * h;
    const Vec3 along(0, l, 0);
    forms.push_back({"hinged " + std::to_string(w) + " " + std::to_string(h) + " " +
                         std::to_string(l) + " at " + std::to_string(degrees),
                     level(0, w, 0, l, 0, true),
                     {Vec3(0), along, up + along, up},
                     f});
  };
  hinged(1, 1, 1, 90, 0.200043776075403);
  hinged(1, 2, 1, 90, 0.232852602795362);
  hinged(2, 1, 1, 90, 0.116426301397681);
  hinged(1, 0.1, 1, 90, 0.0432513694006859);
  hinged(1, 0.5, 1, 90, 0.146186679105713);
  hinged(1, 1, 2, 90, 0.240636006176962);
  hinged(1, 1, 10, 90, 0.281887806787901);
  hinged(1, 1, 1, 30, 0.6190283230908);
  hinged(1, 1, 1, 45, 0.4833476954789);
  hinged(1, 1, 1, 60, 0.3709053211501);
  hinged(1, 1, 1, 120, 0.0866150011183);
  hinged(1, 1, 1, 135, 0.0483094478018);
  hinged(1, 1, 1, 150, 0.0213453254127);

  const Corners floor = level(0, 1, 0, 1, 0, true);
  const auto add = [&](const char* name, const Corners& from, const Corners& to, double f) {
    forms.push_back({name, from, to, f});
  };
  add("parallel, shifted along x", floor, level(1, 2, 0, 1, 1, false), 0.0860504891523);
  add("parallel, shifted along x and y", floor, level(1, 2, 1, 2, 1, false), 0.0433274095741);
  add("perpendicular, one up", floor, upright(0, 0, 1, 1, 2), 0.0328088267200);
  add("perpendicular, corners touch", floor, upright(0, 1, 2, 0, 1), 0.0405922301016);
  add("perpendicular, half apart", floor, upright(-0.5, 0, 1, 0, 1), 0.0761366404227);

  const Corners low = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  add("triangles, aligned", low, {{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}, 0.1150492281496);
  add("triangles, opposite halves", low, {{1, 1, 1}, {1, 0, 1}, {0, 1, 1}}, 0.0847756675488);
  add("triangles on a leg, right angles together", low, {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
      0.5 - 1 / std::sqrt(12.0));
  add("triangles on a leg, right angles apart", low, {{0, 0, 0}, {1, 0, 1}, {1, 0, 0}},
      0.184424034121610);
  const Corners t = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  add("tetrahedron", {t[0], t[2], t[1]}, {t[0], t[1], t[3]}, 1.0 / 3);
  const auto octant = [](double x, double y, double z) {
    Corners c = {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
    if (x * y * z > 0) std::swap(c[1], c[2]);
    return c;
  };
  add("octahedron, by an edge", octant(1, 1, 1), octant(1, 1, -1), 0.1368543063969);
  add("octahedron, by a corner", octant(1, 1, 1), octant(1, -1, -1), 0.1489411180165);
  add("octahedron, opposite", octant(1, 1, 1), octant(-1, -1, -1), 0.1426137267597);
  return forms;
}

/// Two unit plates one apart with a thin obstacle half-way; F from plate to plate, known from the
/// closed forms of plates by F = F_unobstructed - F_through_an_opening, to the digits shown.
struct ObstructedForm {
  std::string name;
  Corners obstacle;
  double f;
};

inline std::vector<ObstructedForm> obstructedForms() {
  const auto centred = [](double side) {
    return level(0.5 - side / 2, 0.5 + side / 2, 0.5 - side / 2, 0.5 + side / 2, 0.5, true);
  };
  return {{"quarter", level(0, 0.5, 0, 0.5, 0.5, true), 0.149868671773790},
          {"half", level(0, 0.5, 0, 1, 0.5, true), 0.0999124478491937},
          {"square 0.1", centred(0.1), 0.1945396236482},
          {"square 0.25", centred(0.25), 0.1694742049118},
          {"square 0.5", centred(0.5), 0.0995062945990},
          {"square 0.75", centred(0.75), 0.0294835449148},
          {"square 0.9", centred(0.9), 0.0049533100175},
          {"strip", level(0.25, 0.75, 0, 1, 0.5, true), 0.0583268459018}};
}

/// Those plates in n x n patches each, lower ones first, then the obstacles, two-sided.
inline PatchMesh blockedPlates(const std::vector<Corners>& obstacles, int n) {
  test::MeshBuilder builder;
  builder.grid("lower", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("upper", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  for (const Corners& o : obstacles) builder.polygon("obstacle", {o}, {}, true);
  return builder.build();
}

}  // namespace radiosity::truth
