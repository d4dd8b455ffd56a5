// Form factors from points against closed forms, and against the exact rows of small patches.
#include "radiosity/point_factors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "radiosity/form_factors.h"
#include "radiosity/scene.h"
#include "support/error_of.h"

namespace radiosity {
namespace {

/// A mesh of quadrilaterals, given by their corners, each cut into about as many patches.
PatchMesh quads(const std::vector<std::array<Vec3, 4>>& corners, std::size_t patches) {
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;
  for (const auto& quad : corners) {
    const auto first = Index(vertices.size());
    vertices.insert(vertices.end(), quad.begin(), quad.end());
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  }
  Material grey;
  grey.name = "grey";
  Progress quiet;
  MeshOptions options;
  options.patches = patches * corners.size();
  return meshScene(sceneOfTriangles(vertices, triangles, {&grey, 1}), options, quiet).mesh;
}

/// A rectangle 0..a x 0..b at height z that faces down.
std::array<Vec3, 4> ceiling(double a, double b, double z) {
  return {{{0, 0, z}, {0, b, z}, {a, b, z}, {a, 0, z}}};
}

/// Howell B-3: to a parallel a x b rectangle a corner of which is above the point, c away.
double rectangleAbove(double a, double b, double c) {
  const double x = a / c;
  const double y = b / c;
  return (x / std::hypot(1, x) * std::atan(y / std::hypot(1, x)) +
          y / std::hypot(1, y) * std::atan(x / std::hypot(1, y))) /
         (2 * std::numbers::pi);
}

std::vector<double> rowOf(const PatchMesh& mesh, const Vec3& point, const Vec3& normal) {
  std::vector<double> row(mesh.size());
  Progress quiet;
  pointFormFactors(mesh, {&point, 1}, {&normal, 1}, row, quiet);
  return row;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(PointFactors, ARectangleInFrontHasItsClosedForm) {
  // Sums of Lambert's terms of a few patches: rounding alone.
  for (const double c : {0.01, 0.7, 30.0}) {
    const PatchMesh mesh = quads({ceiling(2, 1, c)}, 8);
    EXPECT_NEAR(sum(rowOf(mesh, {0, 0, 0}, {0, 0, 2})) / rectangleAbove(2, 1, c), 1, 1e-9);
  }
}

TEST(PointFactors, CoveredPatchesAreNotSeen) {
  const PatchMesh mesh = quads({ceiling(2, 2, 1), ceiling(0.5, 1, 0.5)}, 30);
  const std::vector<double> row = rowOf(mesh, {0, 0, 0}, {0, 0, 1});
  double high = 0;
  double low = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) (mesh.centroid[i].z > 0.7 ? high : low) += row[i];
  // The shadow of the low one on the high one is 1 x 2, just the part that it covers.
  EXPECT_NEAR(low, rectangleAbove(0.5, 1, 0.5), 1e-12);
  EXPECT_NEAR(high, rectangleAbove(2, 2, 1) - rectangleAbove(1, 2, 1), 1e-12);
}

TEST(PointFactors, AWallBlocksPointsBehindIt) {
  // Nothing of the scene is behind the ceiling, so that it blocks no pair of patches.
  const PatchMesh mesh =
      quads({ceiling(1, 1, 1), {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}}, 9);
  EXPECT_EQ(sum(rowOf(mesh, {0.5, 0.5, 2}, {0, 0, -1})), 0);
  EXPECT_NEAR(sum(rowOf(mesh, {0.5, 0.5, 0.5}, {0, 0, -1})), 4 * rectangleAbove(0.5, 0.5, 0.5),
              1e-12);
}

TEST(PointFactors, APointOnASurfaceSeesTheSideOfItsNormal) {
  const PatchMesh mesh =
      quads({ceiling(1, 1, 1), {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}}, 9);
  const double up = 4 * rectangleAbove(0.5, 0.5, 1);
  EXPECT_NEAR(sum(rowOf(mesh, {0.5, 0.5, 0}, {0, 0, 1})), up, 1e-12);
  EXPECT_EQ(sum(rowOf(mesh, {0.5, 0.5, 0}, {0, 0, -1})), 0);
  // Askew, the floor is half of the view below its horizon: 1/2 (1 - cos 45 deg).
  const std::vector<double> askew = rowOf(mesh, {0.5, 0.5, 0}, {1, 0, 1});
  double floor = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) floor += mesh.centroid[i].z < 0.5 ? askew[i] : 0;
  // It is 2e-7 of the diagonal in front of the floor, which is no infinite plane from there.
  EXPECT_NEAR(floor, (1 - std::sqrt(0.5)) / 2, 1e-5);
}

TEST(PointFactors, TheMeanOverAPatchIsItsExactRow) {
  const PatchMesh mesh = quads(
      {ceiling(1, 1, 1), ceiling(0.4, 0.4, 0.5), {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}},
      4);
  Progress quiet;
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  options.tolerance = 1e-6;
  const FormFactors exact = computeFormFactors(mesh, options, quiet);
  const std::size_t from = std::size_t(std::find_if(mesh.centroid.begin(), mesh.centroid.end(),
                                                    [](const Vec3& c) { return c.z < 0.1; }) -
                                       mesh.centroid.begin());
  const auto outline = mesh.outline(from);
  ASSERT_EQ(outline.size(), 4U);
  constexpr int kSide = 40;
  std::vector<Vec3> points;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Vec3& a = mesh.vertices[outline[0]];
      points.push_back(a + (x + 0.5) / kSide * (mesh.vertices[outline[1]] - a) +
                       (y + 0.5) / kSide * (mesh.vertices[outline[3]] - a));
    }
  }
  const std::vector<Vec3> normals(points.size(), mesh.normal[from]);
  std::vector<double> rows(points.size() * mesh.size());
  pointFormFactors(mesh, points, normals, rows, quiet);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double mean = 0;
    for (std::size_t k = 0; k < points.size(); ++k) mean += rows[k * mesh.size() + i];
    // The midpoint rule with kinks where shadows end: second order in 1 / 40.
    EXPECT_NEAR(mean / double(points.size()), exact.matrix->at(from, i), 2e-5) << i;
  }
}

TEST(PointFactors, WrongInputIsReportedByItsRow) {
  const PatchMesh mesh = quads({ceiling(1, 1, 1)}, 1);
  const std::vector<Vec3> points(2, Vec3(0.0));
  std::vector<Vec3> normals(2, Vec3(0, 0, 1));
  std::vector<double> room(2 * mesh.size());
  Progress quiet;
  const auto message = [&](std::span<const Vec3> n, std::span<double> out) {
    return test::errorOf([&] { pointFormFactors(mesh, points, n, out, quiet); });
  };
  EXPECT_NE(message({normals.data(), 1}, room).find("2 points and 1 normals"), std::string::npos);
  EXPECT_NE(message(normals, {room.data(), 1}).find("there is room for 1"), std::string::npos);
  normals[1] = Vec3(0.0);
  EXPECT_NE(message(normals, room).find("normal 1 has no direction"), std::string::npos);
}

}  // namespace
}  // namespace radiosity
