// The subdivision stage: cells of a coarse complex, checked against areas known from the outline,
// brute-force conformity and shape, never against an earlier run.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>

#include "coarse_builder.h"

namespace radiosity {
namespace {

using test::CoarseBuilder;
using test::SceneBuilder;

MeshResult subdivided(CoarseBuilder& input, const MeshOptions& options) {
  Progress progress;
  MeshResult made;
  made.mesh = subdivide(input.complex(), input.scene(), options, made.report, progress);
  return made;
}

MeshOptions count(std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  return options;
}

MeshOptions edge(double longest) {
  MeshOptions options;
  options.max_edge = longest;
  return options;
}

std::vector<Vec2> square(double low, double high) {
  return {{low, low}, {high, low}, {high, high}, {low, high}};
}

std::vector<Vec2> hole(std::vector<Vec2> loop) { return {loop.rbegin(), loop.rend()}; }

double loopArea(const std::vector<Vec2>& loop) {
  double twice = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec2& a = loop[k];
    const Vec2& b = loop[(k + 1) % loop.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

std::size_t bruteForceTJunctions(const PatchMesh& mesh, double tolerance) {
  std::set<std::pair<Index, Index>> edges;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      edges.insert(std::minmax({outline[k], outline[(k + 1) % outline.size()]}));
    }
  }
  const std::set<Index> used(mesh.corners.begin(), mesh.corners.end());
  std::size_t found = 0;
  for (const auto& [from, to] : edges) {
    const Vec3& a = mesh.vertices[from];
    const Vec3& b = mesh.vertices[to];
    for (const Index v : used) {
      const Vec3& p = mesh.vertices[v];
      const double along = glm::dot(p - a, b - a) / glm::length(b - a);
      const double off = glm::length(p - a - along * glm::normalize(b - a));
      if (v != from && v != to && along > tolerance && along < glm::length(b - a) - tolerance &&
          off <= tolerance) {
        ++found;
      }
    }
  }
  return found;
}

/// Along the polygon's normal, counter-clockwise about it, pieces tiling it; triangles and convex
/// quadrilaterals, unless cells were joined for want of patches.
void expectGoodPatches(const PatchMesh& mesh) {
  bool joined = false;
  for (std::size_t i = 0; i < mesh.size(); ++i) joined |= mesh.outline(i).size() > 4;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    const std::size_t n = outline.size();
    ASSERT_GE(n, 3u) << i;
    ASSERT_GT(mesh.area[i], 0) << i;
    const Vec3 facing = mesh.side[i] == 0 ? mesh.polygons.normal[mesh.polygon[i]]
                                          : -mesh.polygons.normal[mesh.polygon[i]];
    EXPECT_EQ(mesh.normal[i], facing) << i;
    double around = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3& a = mesh.vertices[outline[k]];
      const Vec3& b = mesh.vertices[outline[(k + 1) % n]];
      const Vec3& c = mesh.vertices[outline[(k + 2) % n]];
      const Vec3& first = mesh.vertices[outline[0]];
      around += 0.5 * glm::dot(glm::cross(a - first, b - first), mesh.normal[i]);
      if (joined) continue;
      EXPECT_GT(glm::dot(glm::cross(b - a, c - b), mesh.normal[i]), 0) << "patch " << i;
    }
    EXPECT_NEAR(around, mesh.area[i], 1e-10 * mesh.area[i]);
    double pieces = 0;
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      const Vec3& a = mesh.vertices[mesh.pieces[t][0]];
      pieces += 0.5 * glm::dot(glm::cross(mesh.vertices[mesh.pieces[t][1]] - a,
                                          mesh.vertices[mesh.pieces[t][2]] - a),
                               mesh.normal[i]);
    }
    // A few roundings of coordinates of size 1 in areas of size h^2 >= 1e-5.
    EXPECT_NEAR(pieces, mesh.area[i], 1e-10 * mesh.area[i]);
  }
}

double totalArea(const PatchMesh& mesh) {
  long double sum = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) sum += mesh.side[i] == 0 ? mesh.area[i] : 0.0;
  return double(sum);
}

struct Shape {
  std::string name;
  std::vector<std::vector<Vec2>> loops;
  std::vector<std::array<Vec2, 2>> inner = {};
  std::size_t fewest = 1;  ///< fewer cells would have small angles
};

std::vector<Shape> goodShapes() {
  const double degree = glm::radians(1.0);
  const auto ring = [](double r, std::size_t n) {
    return SceneBuilder::regularPolygon({0.0, 0.0}, r, n);
  };
  return {
      {"rectangle", {{{0, 0}, {2, 0}, {2, 1}, {0, 1}}}},
      {"parallelogram", {{{0, 0}, {2, 0}, {2.6, 1}, {0.6, 1}}}},
      {"trapezoid", {{{0, 0}, {2, 0}, {1.8, 1}, {0.1, 1}}}},
      {"L", {{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}},
      {"triangle", {{{0, 0}, {1, 0}, {0.5, 0.8}}}},
      {"turned hole",
       {square(0, 1), hole(SceneBuilder::turnedRectangle({0.45, 0.45}, 0.3, 0.3, 17 * degree))}},
      {"small hole",
       {square(0, 1), hole(SceneBuilder::turnedRectangle({0.3, 0.4}, 0.02, 0.02, 17 * degree))}},
      {"annulus", {ring(1.0, 48), hole(ring(0.4, 24))}},
      {"inner edges",
       {square(0, 1)},
       {{Vec2(0.3, 0.3), Vec2(0.7, 0.5)}, {Vec2(0.7, 0.5), Vec2(0.6, 0.8)}}},
      {"vertex in a side", {{{0, 0}, {0.37, 0}, {1, 0}, {1, 1}, {0, 1}}}},
      {"vertex near a corner", {{{0, 0}, {0.01, 0}, {1, 0}, {1, 1}, {0, 1}}}},
      {"notch",
       {{{0, 0}, {1, 0}, {1, 1}, {0.6, 1}, {0.6, 0.97}, {0.55, 0.97}, {0.55, 1}, {0, 1}}},
       {},
       100},
  };
}

void addShape(CoarseBuilder& input, const Shape& shape) {
  CoarsePolygon& polygon = input.flat(input.surface("shape"), shape.loops);
  for (const auto& [a, b] : shape.inner) input.innerEdge(polygon, Vec3(a, 0.0), Vec3(b, 0.0));
}

double areaOf(const Shape& shape) {
  double area = 0;
  for (const auto& loop : shape.loops) area += loopArea(loop);
  return area;
}

TEST(Subdivide, GoodShapesStayGoodAtEverySize) {
  for (const Shape& shape : goodShapes()) {
    for (const std::size_t wanted : {20u, 300u, 3000u}) {
      if (wanted < shape.fewest) continue;
      SCOPED_TRACE(shape.name + " " + std::to_string(wanted));
      CoarseBuilder input;
      addShape(input, shape);
      const auto [mesh, report] = subdivided(input, count(wanted));
      expectGoodPatches(mesh);
      const double area = areaOf(shape);
      EXPECT_NEAR(totalArea(mesh), area, 1e-12 * area);
      EXPECT_NEAR(report.surfaces[0].kept, area, 1e-12 * area);
      EXPECT_EQ(report.t_junctions, 0u);
      EXPECT_EQ(bruteForceTJunctions(mesh, 1e-7), 0u);
      EXPECT_GE(smallestAngle(mesh), 20.0);
      EXPECT_EQ(report.smallest_angle, smallestAngle(mesh));
      EXPECT_EQ(report.smallest_angle_surface, "shape/shape");
      EXPECT_LE(report.triangles + report.quads, mesh.size());
    }
  }
}

TEST(Subdivide, CountIsWithinFifteenPercentOfTheRequest) {
  for (const Shape& shape : goodShapes()) {
    for (const std::size_t wanted : {300u, 3000u}) {
      CoarseBuilder input;
      addShape(input, shape);
      const auto [mesh, report] = subdivided(input, count(wanted));
      EXPECT_NEAR(double(mesh.size()), double(wanted), 0.15 * double(wanted)) << shape.name;
    }
  }
}

TEST(Subdivide, NoEdgeExceedsTheRequestedLength) {
  for (const Shape& shape : goodShapes()) {
    for (const double longest : {0.3, 0.05}) {
      SCOPED_TRACE(shape.name);
      CoarseBuilder input;
      addShape(input, shape);
      const auto [mesh, report] = subdivided(input, edge(longest));
      // A length that divides evenly is met but for its rounding.
      EXPECT_LE(report.longest_edge, longest * (1 + 1e-9));
      EXPECT_GE(smallestAngle(mesh), 20.0);
      EXPECT_EQ(report.t_junctions, 0u);
      expectGoodPatches(mesh);
      // Without any waste a square grid has area / longest^2 cells.
      const double ideal = areaOf(shape) / (longest * longest);
      EXPECT_LE(double(mesh.size()), 4 * ideal + 200);
    }
  }
}

TEST(Subdivide, RectanglesBecomeGrids) {
  CoarseBuilder input;
  addShape(input, goodShapes()[0]);
  const auto [mesh, report] = subdivided(input, edge(0.25));
  EXPECT_EQ(report.quads, 32u);
  EXPECT_EQ(report.triangles, 0u);
  // Products of fractions with denominators 4 and 8 are exact.
  for (const double area : mesh.area) EXPECT_EQ(area, 0.0625);
  EXPECT_NEAR(report.smallest_angle, 90.0, 1e-12);
}

TEST(Subdivide, SliverNeitherFailsNorExplodes) {
  for (const std::size_t wanted : {1u, 20u, 300u}) {
    CoarseBuilder input;
    input.flat(input.surface("sliver"), {{{0, 0}, {1, 0}, {0.5, 1e-6}}});
    const auto [mesh, report] = subdivided(input, count(wanted));
    EXPECT_LE(mesh.size(), 2 * wanted);
    EXPECT_NEAR(totalArea(mesh), 5e-7, 1e-12 * 5e-7);
    EXPECT_EQ(report.t_junctions, 0u);
    expectGoodPatches(mesh);
  }
}

TEST(Subdivide, EdgesAreSharedAcrossPlanes) {
  CoarseBuilder input;
  const Index s = input.surface("fold");
  // A square, an L and a triangle that meet along edges of different lengths.
  input.polygon(s, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  input.polygon(s, {{{1, 0, 0}, {1, 0, 1}, {1, 0.5, 1}, {1, 0.5, 2}, {1, 1, 2}, {1, 1, 0}}});
  input.polygon(s, {{{0, 0, 0}, {0, 1, 0}, {-0.8, 0.5, 0.3}}});
  for (const std::size_t wanted : {3u, 50u, 1000u}) {
    const auto [mesh, report] = subdivided(input, count(wanted));
    EXPECT_EQ(bruteForceTJunctions(mesh, 1e-7), 0u);
    EXPECT_EQ(countTJunctions(mesh, 1e-7), 0u);
    expectGoodPatches(mesh);
  }
}

/// How often each directed edge occurs.
std::map<std::pair<Index, Index>, int> directedEdges(const PatchMesh& mesh) {
  std::map<std::pair<Index, Index>, int> edges;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      ++edges[{outline[k], outline[(k + 1) % outline.size()]}];
    }
  }
  return edges;
}

TEST(Subdivide, ClosedCubeStaysClosed) {
  for (const std::size_t wanted : {1u, 100u, 777u}) {
    CoarseBuilder input;
    input.cube(input.surface("cube"));
    const auto [mesh, report] = subdivided(input, count(wanted));
    const auto edges = directedEdges(mesh);
    for (const auto& [ends, times] : edges) {
      EXPECT_EQ(times, 1);
      EXPECT_TRUE(edges.count({ends.second, ends.first}));
    }
    // Euler: vertices - edges + faces = 2, so no vertex is left unused or double.
    EXPECT_EQ(mesh.vertices.size() + mesh.size(), edges.size() / 2 + 2);
    EXPECT_EQ(report.triangles, 0u);
    Vec3 sum(0.0);
    for (std::size_t i = 0; i < mesh.size(); ++i) sum += mesh.area[i] * mesh.normal[i];
    EXPECT_LT(glm::length(sum), 1e-12);
  }
}

TEST(Subdivide, TwoSidedSheetHasBacksAfterFronts) {
  CoarseBuilder input;
  const Index sheet = input.surface("sheet");
  const Index table = input.surface("table");
  input.polygon(sheet, {{{0, 0, 1}, {1, 0, 1}, {0.6, 1, 1}}}).back = true;
  input.polygon(table, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
  const auto [mesh, report] = subdivided(input, count(100));
  const std::size_t fronts = mesh.frontCount();
  ASSERT_LT(fronts, mesh.size());
  EXPECT_NEAR(double(fronts), 100, 15);
  ASSERT_EQ(mesh.polygons.size(), 2u);
  EXPECT_EQ(mesh.polygons.back_is_patch[0], 1);
  EXPECT_EQ(mesh.polygons.back_is_patch[1], 0);
  std::set<std::pair<Index, Index>> identities;
  for (Index i = 0; i < mesh.size(); ++i) {
    EXPECT_TRUE(identities.insert({mesh.surface[i], mesh.index_in_surface[i]}).second);
    EXPECT_EQ(mesh.side[i], i < fronts ? 0 : 1);
    const bool has_twin = mesh.surface[i] == sheet;
    ASSERT_EQ(mesh.twin[i] != kNone, has_twin);
    if (!has_twin) continue;
    const Index j = mesh.twin[i];
    EXPECT_EQ(mesh.twin[j], i);
    EXPECT_NE(mesh.side[i], mesh.side[j]);
    EXPECT_EQ(mesh.normal[i], -mesh.normal[j]);
    EXPECT_EQ(mesh.centroid[i], mesh.centroid[j]);
    EXPECT_EQ(mesh.area[i], mesh.area[j]);
    EXPECT_EQ(mesh.source_face[i], mesh.source_face[j]);
    const auto a = mesh.outline(i);
    const auto b = mesh.outline(j);
    EXPECT_TRUE(std::equal(a.begin(), a.end(), b.rbegin(), b.rend()));
  }
  expectGoodPatches(mesh);
  EXPECT_NEAR(report.surfaces[sheet].kept, 0.5, 1e-12);
}

TEST(Subdivide, PolygonsBackToBackAreCutAlike) {
  CoarseBuilder input;
  const Index up = input.surface("up");
  const Index down = input.surface("down");
  const std::vector<Vec3> loop = {{0, 0, 0}, {1, 0, 0}, {0.9, 1, 0}, {0.5, 0.6, 0}, {0, 1, 0}};
  input.polygon(up, {loop}).opposite = 1;
  input.polygon(down, {{loop.rbegin(), loop.rend()}}).opposite = 0;
  const auto [mesh, report] = subdivided(input, count(200));
  EXPECT_EQ(report.t_junctions, 0u);
  expectGoodPatches(mesh);
  // Every edge of one has its reverse in the other: the two close like a bag.
  const auto edges = directedEdges(mesh);
  for (const auto& [ends, times] : edges) {
    EXPECT_EQ(times, edges.at({ends.second, ends.first}));
  }
  EXPECT_NEAR(report.surfaces[up].kept, report.surfaces[down].kept, 1e-14);
}

TEST(Subdivide, PowersOfTwoChangeNothing) {
  for (const Shape& shape : goodShapes()) {
    for (const double factor : {std::ldexp(1.0, -20), std::ldexp(1.0, 20)}) {
      CoarseBuilder input;
      addShape(input, shape);
      const MeshResult plain = subdivided(input, count(150));
      for (Vec3& vertex : input.complex().vertices) vertex *= factor;
      for (Vec3& vertex : input.scene().vertices) vertex *= factor;
      input.complex().coincidence *= factor;
      const MeshResult scaled = subdivided(input, count(150));
      ASSERT_EQ(plain.mesh.corners, scaled.mesh.corners) << shape.name;
      for (std::size_t v = 0; v < plain.mesh.vertices.size(); ++v) {
        ASSERT_EQ(plain.mesh.vertices[v] * factor, scaled.mesh.vertices[v]) << shape.name;
      }
      for (std::size_t i = 0; i < plain.mesh.size(); ++i) {
        ASSERT_EQ(plain.mesh.area[i] * factor * factor, scaled.mesh.area[i]) << shape.name;
      }
    }
  }
}

TEST(Subdivide, DistanceFromTheOriginRoundsVerticesOnly) {
  CoarseBuilder input;
  addShape(input, goodShapes()[5]);
  const MeshResult near = subdivided(input, count(150));
  const Vec3 away(1e6, -1e6, 1e6);
  input.complex().origin = away;
  for (Vec3& vertex : input.scene().vertices) vertex += away;
  const MeshResult far = subdivided(input, count(150));
  ASSERT_EQ(near.mesh.corners, far.mesh.corners);
  EXPECT_EQ(near.mesh.area, far.mesh.area);
  EXPECT_EQ(near.mesh.normal, far.mesh.normal);
  for (std::size_t v = 0; v < near.mesh.vertices.size(); ++v) {
    EXPECT_EQ(near.mesh.vertices[v] + away, far.mesh.vertices[v]);
  }
}

TEST(Subdivide, SourceFaceIsTheOneUnderTheCentroid) {
  CoarseBuilder input;
  const Index s = input.surface("floor");
  CoarsePolygon& polygon = input.flat(s, {square(0, 1)});
  // The merged square came from four quarters; the builder's own face is not among them.
  SceneBuilder quarters;
  quarters.surface("floor");
  quarters.level(0, 0, 0, 0.5, 0.5, 0);
  quarters.level(0, 0.5, 0, 1, 0.5, 0);
  quarters.level(0, 0, 0.5, 0.5, 1, 0);
  quarters.level(0, 0.5, 0.5, 1, 1, 0);
  polygon.faces = {0, 1, 2, 3};
  input.scene() = quarters.scene();
  const auto [mesh, report] = subdivided(input, count(49));
  ASSERT_EQ(mesh.size(), 49u);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Vec3& c = mesh.centroid[i];
    if (std::abs(c.x - 0.5) < 1e-9 || std::abs(c.y - 0.5) < 1e-9) continue;  // on a seam
    EXPECT_EQ(mesh.source_face[i], (c.x > 0.5 ? 1u : 0u) + (c.y > 0.5 ? 2u : 0u));
  }
}

TEST(Subdivide, ManySmallPolygonsLeaveLargeOnesCut) {
  // A wall of 16 m^2 above 400 loose tiles of 1 cm: 50 patches are impossible. Shared out evenly
  // the wall's patches would be 0.57 m wide; one and a half times that is 5 x 5 of them.
  CoarseBuilder input;
  const Index wall = input.surface("wall");
  const Index tiles = input.surface("tiles");
  input.flat(wall, {square(0, 4)});
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      const double u = 0.2 * x;
      const double v = 0.2 * y;
      input.polygon(tiles,
                    {{{u, v, 1}, {u + 0.01, v, 1}, {u + 0.01, v + 0.01, 1}, {u, v + 0.01, 1}}});
    }
  }
  const auto [mesh, report] = subdivided(input, count(50));
  EXPECT_EQ(std::count(mesh.surface.begin(), mesh.surface.end(), tiles), 400);
  EXPECT_EQ(std::count(mesh.surface.begin(), mesh.surface.end(), wall), 25);
  ASSERT_EQ(report.notes.size(), 1u);
  EXPECT_EQ(report.notes[0].text,
            "425 patches: 50 were asked for, but there are 401 planar pieces");
}

TEST(Subdivide, NarrowingQuadrilateralsDoNotSpreadFineCuts) {
  // A cone of 40 slender frustum sides: each ring is narrower than the last by a factor 1.4, so the
  // chain of opposite edges spans 1.4^6 = 7.5. Cut alike throughout, the top would be 7 times too
  // fine.
  CoarseBuilder input;
  const Index s = input.surface("cone");
  const auto ring = [](int level, int k) {
    const double r = 10 / std::pow(1.4, level);
    const double a = 2 * M_PI * k / 40;
    return Vec3(r * std::cos(a), r * std::sin(a), 12 - r);
  };
  for (int level = 0; level < 6; ++level) {
    for (int k = 0; k < 40; ++k) {
      // The flat side between two rings is an isosceles trapezoid.
      input.polygon(s, {{ring(level, k), ring(level, (k + 1) % 40), ring(level + 1, (k + 1) % 40),
                         ring(level + 1, k)}});
    }
  }
  const auto [mesh, report] = subdivided(input, edge(0.4));
  EXPECT_EQ(report.t_junctions, 0u);
  EXPECT_GE(smallestAngle(mesh), 20.0);
  expectGoodPatches(mesh);
  double shortest = 10;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      shortest = std::min(shortest, glm::length(mesh.vertices[outline[k]] -
                                                mesh.vertices[outline[(k + 1) % outline.size()]]));
    }
  }
  EXPECT_GT(shortest, 0.4 / 4);
}

TEST(Subdivide, SharpCornerKeepsItsPointsOffTheOtherEdge) {
  // Near the tip the sides are closer than the coincidence: points there would be T-junctions.
  for (const double height : {1e-6, 3e-6, 1e-4}) {
    CoarseBuilder input;
    input.flat(input.surface("needle"), {{{0, 0}, {1, 0}, {0.3, height}}});
    const auto [mesh, report] = subdivided(input, edge(0.01));
    EXPECT_EQ(bruteForceTJunctions(mesh, 1e-7), 0u) << height;
  }
}

TEST(Subdivide, StripsWithVerticesOnOneSideGetNoFans) {
  // 2 cm between a long edge and a row of 30 others, 5 cm long: from the only cuts of the long edge
  // at 0.3 m, triangles to the row would have angles of 4 degrees and less.
  CoarseBuilder input;
  std::vector<Vec2> strip = {{0, 0}, {1.5, 0}, {1.5, 0.02}};
  for (int k = 29; k >= 0; --k) strip.emplace_back(0.05 * k, 0.02);
  input.flat(input.surface("strip"), {strip});
  // A gable along the long edge shares its cuts.
  input.polygon(input.surface("gable"),
                {{{1.5, 0, 0}, {0, 0, 0}, {0, 0, 1}, {0.7, 0, 1.4}, {1.5, 0, 1}}});
  const double area = 1.5 * 0.02 + 1.5 + 0.5 * 1.5 * 0.4;
  for (const MeshOptions& options : {edge(0.3), edge(0.2), count(300), count(1000)}) {
    SCOPED_TRACE(fmt::format("edge {}, {} patches", options.max_edge, options.patches));
    const auto [mesh, report] = subdivided(input, options);
    EXPECT_GE(smallestAngle(mesh), 20.0);
    EXPECT_EQ(bruteForceTJunctions(mesh, 1e-7), 0u);
    EXPECT_NEAR(totalArea(mesh), area, 1e-12 * area);
    expectGoodPatches(mesh);
    if (options.max_edge > 0) {
      EXPECT_LE(report.longest_edge, options.max_edge * (1 + 1e-9));
    } else {
      EXPECT_NEAR(double(mesh.size()), double(options.patches), 0.15 * double(options.patches));
    }
  }
}

TEST(Subdivide, HolesBesideALongEdgeKeepTheCount) {
  for (const int books : {1, 4}) {
    CoarseBuilder input;
    std::vector<std::vector<Vec2>> loops = {{{0, 0}, {1.5, 0}, {1.5, 0.3}, {0, 0.3}}};
    const double width = 0.65 / books;
    for (int k = 0; k < books; ++k) {
      const double x = 0.1 + 2 * width * k;
      loops.push_back(hole({{x, 0.1}, {x + width, 0.1}, {x + width, 0.28}, {x, 0.28}}));
    }
    input.flat(input.surface("shelf"), loops);
    const double area = 1.5 * 0.3 - 0.65 * 0.18;
    for (const std::size_t wanted : {200u, 1000u}) {
      const auto [mesh, report] = subdivided(input, count(wanted));
      EXPECT_EQ(bruteForceTJunctions(mesh, 1e-7), 0u);
      EXPECT_NEAR(totalArea(mesh), area, 1e-12 * area);
      expectGoodPatches(mesh);
      EXPECT_NEAR(double(mesh.size()), double(wanted), 0.15 * double(wanted));
    }
  }
}

TEST(Subdivide, HiddenVerticesCutNothing) {
  // A slit 1 cm from the long edge hides the slit behind it, its ends included.
  CoarseBuilder input;
  input.flat(input.surface("plate"), {{{0, 0}, {4, 0}, {4, 4}, {0, 4}},
                                      hole({{1, 0.01}, {3, 0.01}, {3, 0.02}, {1, 0.02}}),
                                      hole({{1.7, 0.03}, {2.2, 0.03}, {2.2, 0.04}, {1.7, 0.04}})});
  const auto [mesh, report] = subdivided(input, edge(2));
  std::set<double> cuts;
  for (const Vec3& v : mesh.vertices) {
    if (v.y == 0) cuts.insert(v.x);
  }
  // Opposite of the first slit's ends, and none between.
  EXPECT_EQ(cuts, (std::set<double>{0, 1, 3, 4}));
}

TEST(Subdivide, HugeEdgesCutNothingAndTinyOnesAreRefused) {
  CoarseBuilder input;
  input.cube(input.surface("cube"));
  EXPECT_EQ(subdivided(input, edge(1e9)).mesh.size(), 6u);
  EXPECT_THROW(subdivided(input, edge(1e-4)), InputError);
  EXPECT_THROW(subdivided(input, edge(1e-300)), InputError);
}

TEST(Subdivide, NothingToDivideIsAnError) {
  CoarseBuilder input;
  EXPECT_THROW(subdivided(input, count(10)), InputError);
}

TEST(MeshOptions, RangesAreChecked) {
  EXPECT_NO_THROW(MeshOptions().validate());
  MeshOptions options;
  options.patches = 0;
  EXPECT_THROW(options.validate(), InputError);
  options.patches = 30'000'000;
  EXPECT_THROW(options.validate(), InputError);
  EXPECT_THROW(edge(-1).validate(), InputError);
  EXPECT_THROW(edge(std::nan("")).validate(), InputError);
  options = {};
  options.weld = 0.1;
  EXPECT_THROW(options.validate(), InputError);
}

TEST(TJunctions, AreTheSameByGridAndByBruteForce) {
  // A square beside two that share only half of its side each, one of them far below.
  PatchMesh mesh;
  mesh.corner_offset = {0, 4, 8, 12};
  mesh.vertices = {{0, 0, 0}, {1, 0, 0},   {1, 1, 0}, {0, 1, 0},  {1, 0.3, 0},
                   {2, 0, 0}, {2, 0.3, 0}, {2, 1, 0}, {1, 0.6, 5}};
  mesh.corners = {0, 1, 2, 3, 1, 5, 6, 4, 4, 6, 7, 2};
  mesh.area = {1, 0.3, 0.7};
  EXPECT_EQ(bruteForceTJunctions(mesh, 1e-7), 1u);
  EXPECT_EQ(countTJunctions(mesh, 1e-7), 1u);
  mesh.vertices[4].y = 1e-9;  // coincides with the corner: no junction inside the edge
  EXPECT_EQ(countTJunctions(mesh, 1e-7), bruteForceTJunctions(mesh, 1e-7));
}

}  // namespace
}  // namespace radiosity
