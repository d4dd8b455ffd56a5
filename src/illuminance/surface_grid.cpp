// Grids over planar surfaces of a scene.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/finite.h"
#include "base/geometry/plane_frame.h"
#include "illuminance/directions.h"
#include "illuminance/grid.h"
#include "scene/surface_names.h"

namespace radiosity {
namespace {

/// Faces are in one plane if no corner is further off it than this share of their size: walls of
/// measured rooms are bent by half a percent. What is bent by more than kBent is told.
constexpr double kFlat = 0.01;
constexpr double kBent = 1e-5;
/// Faces that are turned both ways are a board's two sides if the smaller side is more than this
/// share of the larger one. Else they are a sheet, of which some face the wrong way.
constexpr double kBoard = 0.5;
/// A rectangle along other edges has to be smaller by this, so that squares keep to the axes.
constexpr double kSmaller = 1 - 1e-6;

struct Faces {
  std::vector<std::size_t> number;  ///< of the scene
  std::vector<Vec3> area;           ///< vector area of each
};

Vec3 vectorAreaOf(const Scene& scene, std::size_t face) {
  const std::span<const Index> corners = scene.face(face);
  return vectorArea(corners.size(), [&](std::size_t k) { return scene.vertices[corners[k]]; });
}

Faces facesOf(const Scene& scene, const std::vector<Index>& surfaces) {
  Faces faces;
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    if (!std::ranges::binary_search(surfaces, scene.face_surface[f])) continue;
    const Vec3 area = vectorAreaOf(scene, f);
    if (!(glm::length(area) > 0)) continue;
    faces.number.push_back(f);
    faces.area.push_back(area);
  }
  return faces;
}

/// The plane that faces are in: their mean normal, of those turned both ways as the largest, and
/// the corner that is foremost.
struct SurfacePlane {
  Vec3 normal{0.0};  ///< unit
  double front = 0;  ///< dot(normal, x) of the foremost corner, ...
  double back = 0;   ///< ... and of the one furthest behind
  double size = 0;   ///< the distance of the corner furthest from the first one
  bool isFlat() const { return front - back <= kFlat * size; }
  SurfacePlane turned() const { return {-normal, -back, -front, size}; }
};

/// Of one or more faces.
SurfacePlane meanPlane(const Scene& scene, const Faces& faces) {
  const Vec3 largest = *std::ranges::max_element(
      faces.area, {}, [](const Vec3& area) { return glm::dot(area, area); });
  Vec3 sum(0.0);
  for (const Vec3& area : faces.area) sum += glm::dot(area, largest) < 0 ? -area : area;
  SurfacePlane plane;
  plane.normal = glm::normalize(sum);
  plane.front = -std::numeric_limits<double>::infinity();
  plane.back = -plane.front;
  const Vec3 origin = scene.vertices[scene.face(faces.number[0])[0]];
  for (const std::size_t f : faces.number) {
    for (const Index corner : scene.face(f)) {
      const Vec3& at = scene.vertices[corner];
      plane.size = std::max(plane.size, glm::distance(at, origin));
      plane.front = std::max(plane.front, glm::dot(plane.normal, at));
      plane.back = std::min(plane.back, glm::dot(plane.normal, at));
    }
  }
  return plane;
}

/// The faces that face as the unit `normal` does, but for an angle of the cosine `least` or more.
Faces facing(const Faces& faces, const Vec3& normal, double least) {
  Faces out;
  for (std::size_t k = 0; k < faces.number.size(); ++k) {
    if (!(glm::dot(glm::normalize(faces.area[k]), normal) > least)) continue;
    out.number.push_back(faces.number[k]);
    out.area.push_back(faces.area[k]);
  }
  return out;
}

double totalArea(const Faces& faces) {
  double sum = 0;
  for (const Vec3& area : faces.area) sum += glm::length(area);
  return sum;
}

bool isTwoSided(const Scene& scene, const Faces& faces) {
  return std::ranges::all_of(faces.number,
                             [&](std::size_t f) { return scene.materialOf(f).two_sided; });
}

/// The convex hull, counter-clockwise (A. Andrew, Inf. Proc. Letters 9(5), 1979).
std::vector<Vec2> hullOf(std::vector<Vec2> points) {
  std::ranges::sort(
      points, [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross2(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// The rectangle around the hull with a side along `u`, in its coordinates (u, v).
PlaneArea boundsAlong(const PlaneFrame& flat, const std::vector<Vec2>& hull, const Vec2& u) {
  PlaneArea area;
  area.frame = makeFrame(flat.origin, flat.n, u.x * flat.u + u.y * flat.v);
  area.low = Vec2(std::numeric_limits<double>::infinity());
  area.high = -area.low;
  for (const Vec2& p : hull) {
    const Vec2 at{glm::dot(p, u), cross2(u, p)};
    area.low = glm::min(area.low, at);
    area.high = glm::max(area.high, at);
  }
  return area;
}

double sizeOf(const PlaneArea& area) {
  return (area.high.x - area.low.x) * (area.high.y - area.low.y);
}

/// The smallest rectangle: one side lies along an edge of the hull (Freeman & Shapira, CACM 18(7),
/// 1975).
PlaneArea smallestArea(const PlaneFrame& flat, const std::vector<Vec2>& hull) {
  PlaneArea best = boundsAlong(flat, hull, {1, 0});
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2 edge = hull[(k + 1) % hull.size()] - hull[k];
    if (!(glm::length(edge) > 0)) continue;
    const PlaneArea other = boundsAlong(flat, hull, glm::normalize(edge));
    if (sizeOf(other) < kSmaller * sizeOf(best)) best = other;
  }
  return best;
}

/// The same rectangle, turned so that columns point up on walls, and rows to the right, +x, on
/// floors.
PlaneArea turned(const PlaneArea& area, Up up) {
  PlaneArea best = area;
  double most = -std::numeric_limits<double>::infinity();
  PlaneArea now = area;
  for (int quarter = 0; quarter < 4; ++quarter) {
    constexpr double kUpFirst = 10;
    const double score = kUpFirst * glm::dot(now.frame.v, upVector(up)) + now.frame.u.x;
    if (score > most + 1e-9) {
      most = score;
      best = now;
    }
    // A quarter on: u becomes v, and v becomes -u.
    std::swap(now.frame.u, now.frame.v);
    now.frame.v = -now.frame.v;
    now = {now.frame, {now.low.y, -now.high.x}, {now.high.y, -now.low.x}};
  }
  return best;
}

/// Whether a point is in a face's outline, by the crossings of a ray to the right. Of two faces on
/// either side of an edge just one has a point on it: both have the same crossing, to the last bit,
/// since it is computed from the lower end up.
bool holds(const std::vector<Vec2>& outline, const Vec2& p) {
  bool inside = false;
  for (std::size_t k = 0, before = outline.size() - 1; k < outline.size(); before = k++) {
    Vec2 a = outline[k];
    Vec2 b = outline[before];
    if ((a.y > p.y) == (b.y > p.y)) continue;
    if (b.y < a.y) std::swap(a, b);
    if (p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside;
}

/// Marks the cells whose points a face holds.
void mark(const std::vector<Vec2>& outline, const PlaneArea& area, const GridLine& columns,
          const GridLine& rows, std::vector<std::uint8_t>& held) {
  Vec2 low(std::numeric_limits<double>::infinity());
  Vec2 high = -low;
  for (const Vec2& p : outline) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const auto range = [](double from, double to, double begin, const GridLine& line) {
    const double first = std::ceil((from - begin - line.first) / line.step - 1e-9);
    const double last = std::floor((to - begin - line.first) / line.step + 1e-9);
    return std::pair(std::ptrdiff_t(std::max(first, 0.0)),
                     std::ptrdiff_t(std::min(last, double(line.count) - 1)));
  };
  const auto [left, right] = range(low.x, high.x, area.low.x, columns);
  const auto [bottom, top] = range(low.y, high.y, area.low.y, rows);
  for (std::ptrdiff_t row = bottom; row <= top; ++row) {
    for (std::ptrdiff_t column = left; column <= right; ++column) {
      const Vec2 at = area.low + Vec2(columns.first + double(column) * columns.step,
                                      rows.first + double(row) * rows.step);
      if (holds(outline, at)) held[std::size_t(row) * columns.count + std::size_t(column)] = 1;
    }
  }
}

struct PlanarFaces {
  Faces faces;
  SurfacePlane plane;  ///< its normal is the way that the grid faces
  std::vector<Note> notes;
};

/// The faces of a body that face up.
void takeTop(const Scene& scene, const std::string& name, PlanarFaces& planar) {
  constexpr double kLevel = 0.999;
  const std::size_t all = planar.faces.number.size();
  planar.faces = facing(planar.faces, upVector(scene.up), kLevel);
  if (!planar.faces.number.empty()) planar.plane = meanPlane(scene, planar.faces);
  if (planar.faces.number.empty() || !planar.plane.isFlat()) {
    throw InputError(fmt::format(
        "grid: {} is not planar, nor are its faces that face up; name a planar surface, or give a "
        "plane by three corners",
        name));
  }
  planar.notes.push_back(
      {Severity::info, fmt::format("grid: {} is not planar; its points stand over the {} of its {} "
                                   "faces that face up",
                                   name, planar.faces.number.size(), all)});
}

/// Of one-sided faces in one plane the side that is meant: the larger one of a sheet, the upper one
/// of a thin board.
void takeSide(const Scene& scene, const std::string& name, PlanarFaces& planar) {
  // What is left out stands across: the edges of a board.
  constexpr double kAcross = kFlat;
  const Vec3 normal = planar.plane.normal;
  Faces side = facing(planar.faces, normal, kAcross);
  Faces other = facing(planar.faces, -normal, kAcross);
  if (totalArea(other) > totalArea(side)) std::swap(side, other);
  const std::size_t turned_away = other.number.size();
  const std::size_t all = planar.faces.number.size();
  const double up = glm::dot(normal, upVector(scene.up));
  if (totalArea(other) <= kBoard * totalArea(side)) {
    if (turned_away > 0) {
      planar.notes.push_back(
          {Severity::info,
           fmt::format("grid: {} of the {} faces of {} face{} the other way and {} left out",
                       turned_away, all, name, turned_away == 1 ? "s" : "",
                       turned_away == 1 ? "is" : "are")});
    }
  } else if (std::abs(up) > kFlat) {
    if (glm::dot(side.area[0], upVector(scene.up)) < 0) std::swap(side, other);
    planar.notes.push_back(
        {Severity::info, fmt::format("grid: {} is a thin board; its points stand over the {} of "
                                     "its {} faces that face up",
                                     name, side.number.size(), all)});
  } else {
    throw InputError(fmt::format(
        "grid: {} is a thin board, and neither of its sides faces up; name a surface that is one "
        "side, or give a plane by three corners",
        name));
  }
  planar.faces = std::move(side);
  planar.plane = meanPlane(scene, planar.faces);
}

/// Of the surfaces that `name` stands for, the faces that are meant.
PlanarFaces planarFaces(const Scene& scene, const std::string& name,
                        const std::vector<Index>& surfaces) {
  PlanarFaces out;
  out.faces = facesOf(scene, surfaces);
  if (out.faces.number.empty()) {
    throw InputError(
        fmt::format("grid: {} has no area; name another surface, or give a plane", name));
  }
  out.plane = meanPlane(scene, out.faces);
  if (!out.plane.isFlat()) {
    takeTop(scene, name, out);
  } else if (!isTwoSided(scene, out.faces)) {
    takeSide(scene, name, out);
  } else if (glm::dot(out.plane.normal, upVector(scene.up)) < -kFlat) {
    out.plane = out.plane.turned();
  }
  return out;
}

/// Whether surfaces are one sheet: in one plane, and all their faces face alike.
bool isOneSheet(const Scene& scene, const std::vector<Index>& surfaces) {
  const Faces faces = facesOf(scene, surfaces);
  if (faces.number.empty()) return true;
  const SurfacePlane plane = meanPlane(scene, faces);
  return plane.isFlat() && facing(faces, plane.normal, 0).number.size() == faces.number.size();
}

std::vector<Index> surfacesOrRefuse(const Scene& scene, const std::string& name) {
  std::vector<Index> surfaces = surfacesMeant(scene, name);
  if (surfaces.empty()) throw InputError("grid: " + unknownNameText(scene, name));
  return surfaces;
}

/// Notes how far a surface is off its plane, if that is more than rounding of files.
void noteBend(const std::string& name, const Vec2& sides, PlanarFaces& planar) {
  const double bend = planar.plane.front - planar.plane.back;
  if (bend <= kBent * std::max(sides.x, sides.y)) return;
  planar.notes.push_back(
      {Severity::info,
       fmt::format("grid: {} is bent by {:.3g} m; heights are over its foremost corner", name,
                   bend)});
}

MeasuringPoints pointsOver(const Scene& scene, const std::string& name,
                           const std::vector<Index>& surfaces, double height,
                           std::optional<double> spacing) {
  if (!std::isfinite(height)) throw InputError("grid: the height is no finite number of metres");
  PlanarFaces planar = planarFaces(scene, name, surfaces);
  if (height < 0) planar.plane = planar.plane.turned();
  const Vec3 normal = planar.plane.normal;
  const Vec3 corner = scene.vertices[scene.face(planar.faces.number[0])[0]];
  const Vec3 origin = corner + (planar.plane.front - glm::dot(normal, corner)) * normal;
  const PlaneFrame flat = makeFrame(origin, normal, axisAcross(normal));
  std::vector<Vec2> corners;
  for (const std::size_t f : planar.faces.number) {
    for (const Index at : scene.face(f)) corners.push_back(flat.flat(scene.vertices[at]));
  }
  const PlaneArea area = turned(smallestArea(flat, hullOf(std::move(corners))), scene.up);
  const Vec2 sides = area.high - area.low;
  noteBend(name, sides, planar);
  const std::string what = "grid: " + name;
  const GridLine columns = gridLine(what, sides.x, sides.y, spacing);
  const GridLine rows = gridLine(what, sides.y, sides.x, spacing);
  requireFewPoints(what, columns, rows);
  std::vector<std::uint8_t> held(columns.count * rows.count, 0);
  std::vector<Vec2> outline;
  for (const std::size_t f : planar.faces.number) {
    outline.clear();
    for (const Index at : scene.face(f)) outline.push_back(area.frame.flat(scene.vertices[at]));
    mark(outline, area, columns, rows, held);
  }
  MeasuringPoints out;
  out.name = height == 0 ? name : fmt::format("{} + {:.6g} m", name, std::abs(height));
  if (height < 0) out.name = fmt::format("{} - {:.6g} m", name, -height);
  out.notes = std::move(planar.notes);
  out.grid =
      MeasuringPoints::Grid{.first = area.frame.lift(area.low + Vec2(columns.first, rows.first)) +
                                     std::abs(height) * normal,
                            .u = area.frame.u,
                            .v = area.frame.v,
                            .step_u = columns.step,
                            .step_v = rows.step,
                            .columns = columns.count,
                            .rows = rows.count};
  for (std::size_t cell = 0; cell < held.size(); ++cell) {
    if (held[cell] == 0) continue;
    const std::size_t column = cell % columns.count;
    const std::size_t row = cell / columns.count;
    out.at.push_back(out.grid->first + double(column) * columns.step * area.frame.u +
                     double(row) * rows.step * area.frame.v);
    out.cell.push_back(cell);
  }
  if (out.at.empty()) {
    throw InputError(fmt::format(
        "{}: no point of a grid of {:.6g} m lies within its outline; give a smaller spacing", what,
        columns.step));
  }
  out.normal.assign(out.at.size(), withoutMinusZero(normal));
  return out;
}

}  // namespace

MeasuringPoints pointsOverSurface(const Scene& scene, const std::string& name, double height,
                                  std::optional<double> spacing) {
  return pointsOver(scene, name, surfacesOrRefuse(scene, name), height, spacing);
}

std::vector<MeasuringPoints> pointsOverSurfaces(const Scene& scene, const std::string& name,
                                                double height, std::optional<double> spacing) {
  const std::vector<Index> surfaces = surfacesOrRefuse(scene, name);
  if (!surfacesNamed(scene, name).empty() || isOneSheet(scene, surfaces)) {
    return {pointsOver(scene, name, surfaces, height, spacing)};
  }
  std::vector<MeasuringPoints> sets;
  for (const Index surface : surfaces) {
    try {
      sets.push_back(pointsOver(scene, scene.surfaces[surface].name, {surface}, height, spacing));
    } catch (const InputError& error) {
      if (surfaces.size() == 1) throw;
      throw InputError(fmt::format("{} (it is one of the {} surfaces that {} means)", error.what(),
                                   surfaces.size(), name));
    }
  }
  return sets;
}

}  // namespace radiosity
