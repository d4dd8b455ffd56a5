// Form factors against closed forms: point values as the resolution rises, area values as patches
// shrink, with the order at which they converge.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "formfactor/hemicube/row_builder.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using Loop = MeshBuilder::Loop;

/// Lambert's formula: the form factor from an element at the origin facing +z to a polygon above
/// its horizon, counter-clockwise seen from its front, front towards the element (Baum et al. 1989,
/// eq. 9).
double lambert(const Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Vec3& a = loop[k];
    const Vec3& b = loop[(k + 1) % loop.size()];
    const Vec3 c = glm::cross(a, b);
    sum -= c.z / glm::length(c) * std::atan2(glm::length(c), glm::dot(a, b));
  }
  return sum / (2 * std::numbers::pi);
}

/// Root mean square error of the hemicube over `seeds` random turns, for an eye at the origin
/// facing +z and one polygon.
double rmsError(const std::vector<Loop>& loops, double truth, int resolution, int seeds = 32) {
  MeshBuilder builder;
  builder.polygon("target", loops, {loops.front()});
  const PatchMesh mesh = builder.build();
  const ViewScene scene(mesh);
  const DeltaFormFactors weights(resolution);
  Hemicube hemicube(scene, weights, rasterKernels(true));
  double squares = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const double angle = turnAngle(mesh, 0, std::uint64_t(seed));
    const HemicubeView& view =
        hemicube.look(eyeFrame(Vec3(0.0), Vec3(0, 0, 1), angle), kNone, nullptr);
    squares += std::pow(view.fronts - truth, 2);
  }
  return std::sqrt(squares / seeds);
}

/// Slope of log(error) against log(size), least squares: the order of convergence.
double measuredOrder(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = double(sizes.size());
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    const double x = std::log(sizes[k]);
    const double y = std::log(errors[k]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Rms over 32 turns scatters by 1/sqrt(64) = 12%, so a slope over five doublings is uncertain by
/// about 0.1; `order` is asserted to three times that.
void expectOrder(const std::vector<Loop>& loops, double truth, double order,
                 double relative_at_512) {
  std::vector<double> sizes;
  std::vector<double> errors;
  for (const int resolution : {16, 32, 64, 128, 256, 512}) {
    sizes.push_back(1.0 / resolution);
    errors.push_back(rmsError(loops, truth, resolution));
  }
  const double measured = measuredOrder(sizes, errors);
  testing::Test::RecordProperty("order", std::to_string(measured));
  testing::Test::RecordProperty("error", std::to_string(errors.back() / truth));
  EXPECT_NEAR(measured, order, 0.3);
  EXPECT_LT(errors.back(), relative_at_512 * truth);
}

// Pixel-centre sampling of an edge at a random angle to the grid errs by about a pixel's area
// times the square root of the number of pixels along it: h^2 h^(-1/2), order 3/2.
constexpr double kSlantedEdges = 1.5;
// Edges parallel to the eye's normal stay aligned with the columns of the side faces however the
// hemicube is turned: all pixels along them err alike, by up to h/2 times their length, order 1.
constexpr double kUprightEdges = 1.0;

// Bounds on the error at 512 pixels: a target of n pixels errs by about 0.54 n^(-3/4), so 1e-3 to
// 1.3e-4 for 1e4 to 7e4 pixels, doubled. Upright edges: uniformly distributed within a pixel, two
// edges err by h/sqrt(6) = 1.6e-3 of the target's unit width (h = 1/256), doubled.

TEST(PointValues, AFacingRectangleConverges) {
  const Loop square = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
  const double b3 = 0.138531605994893;  // Howell B-3, all sides 1
  EXPECT_NEAR(lambert(square), b3, 1e-14);
  expectOrder({square}, b3, kSlantedEdges, 4e-4);
}

TEST(PointValues, APerpendicularRectangleConverges) {
  const Loop square = {{1, 0, 0}, {1, 0, 1}, {1, 1, 1}, {1, 1, 0}};
  const double b4 = 0.0557341970025535;  // Howell B-4, all sides 1
  EXPECT_NEAR(lambert(square), b4, 1e-14);
  expectOrder({square}, b4, kUprightEdges, 3.2e-3);
}

TEST(PointValues, ADiscOverheadConverges) {
  Loop disc;
  const int corners = 1024;
  for (int k = 0; k < corners; ++k) {
    const double a = -2 * std::numbers::pi * k / corners;
    disc.emplace_back(0.7 * std::cos(a), 0.7 * std::sin(a), 1.0);
  }
  const double truth = 0.49 / 1.49;  // r^2 / (r^2 + h^2)
  // The inscribed polygon falls short by 2 pi^2 / (3 n^2) of the area, 6e-6.
  EXPECT_NEAR(lambert(disc), truth, 1e-5);
  expectOrder({disc}, truth, kSlantedEdges, 4e-4);
}

TEST(PointValues, AConcavePolygonConverges) {
  const Loop ell = {{-0.8, -0.8, 1}, {-0.8, 0.9, 1}, {-0.3, 0.9, 1},
                    {-0.3, -0.2, 1}, {0.9, -0.2, 1}, {0.9, -0.8, 1}};
  expectOrder({ell}, lambert(ell), kSlantedEdges, 4e-4);
}

TEST(PointValues, APolygonWithAHoleConverges) {
  const Loop outer = {{-0.9, -0.8, 1}, {-0.9, 0.8, 1}, {0.9, 0.8, 1.1}, {0.9, -0.8, 1.1}};
  // The hole lies in the same plane, z = 1.05 + x / 18, and runs the other way.
  const auto at = [](double x, double y) { return Vec3(x, y, 1.05 + x / 18); };
  const Loop hole = {at(-0.4, -0.5), at(0.5, -0.3), at(0.1, 0.6)};
  expectOrder({outer, hole}, lambert(outer) + lambert(hole), kSlantedEdges, 4e-4);
}

TEST(PointValues, APolygonAcrossTheHorizonConverges) {
  // Half of the polygon is below the horizon and must not count.
  const Loop whole = {{1, -0.5, -1}, {1, -0.5, 1}, {1, 0.5, 1}, {1, 0.5, -1}};
  const Loop above = {{1, -0.5, 0}, {1, -0.5, 1}, {1, 0.5, 1}, {1, 0.5, 0}};
  expectOrder({whole}, lambert(above), kUprightEdges, 3.2e-3);
}

/// Area-to-area form factor from surface 0 to surface 1: area mean of the rows.
double areaValue(const PatchMesh& mesh, int resolution, Index from = 0, Index to = 1) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  options.precision = Precision::double_precision;
  Progress silent;
  const FormFactors f = computeFormFactors(mesh, options, silent);
  double sum = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.surface[i] != from) continue;
    area += mesh.area[i];
    pairsOf(*f.matrix).forRow(i, [&](Index j, double value) {
      if (mesh.surface[j] == to) sum += mesh.area[i] * value;
    });
  }
  return sum / area;
}

PatchMesh parallelSquares(int n) {
  MeshBuilder builder;
  builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  builder.grid("high", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
  return builder.build();
}

/// Rectangles l x w (floor) and l x h (wall) sharing the edge of length l.
PatchMesh perpendicularRectangles(double w, double h, int n_floor, int n_wall) {
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, w, 0}, n_floor, n_floor);
  builder.grid("wall", {0, 0, 0}, {0, 0, h}, {1, 0, 0}, n_wall, n_wall);
  return builder.build();
}

TEST(AreaValues, OnePointSeesThePointValue) {
  // Not the area value (0.199825, 0.200044): the row is right for its one point. At 1024 pixels
  // the targets cover more than 1e5 pixels: 0.54 n^(-3/4) < 1e-4, four times that.
  EXPECT_NEAR(areaValue(parallelSquares(1), 1024), 0.239456, 1e-4);
  EXPECT_NEAR(areaValue(perpendicularRectangles(1, 1, 1, 1), 1024), 0.190136, 8e-5);
}

void expectAreaOrder(const std::vector<double>& errors, double order, double last) {
  std::vector<double> sizes;
  for (std::size_t k = 0; k < errors.size(); ++k) sizes.push_back(std::ldexp(1.0, -int(k)));
  const double measured = measuredOrder(sizes, errors);
  testing::Test::RecordProperty("order", std::to_string(measured));
  EXPECT_NEAR(measured, order, 0.2);
  EXPECT_LT(errors.back(), last);
}

TEST(AreaValues, ParallelSquaresConvergeToSecondOrder) {
  // Midpoint rule over the patches of a smooth integrand: order 2. The hemicubes' own error at
  // 512 pixels, averaged over the patches, is below 1e-5 and bends the line little. One patch a
  // square is not yet small, hence the 0.2.
  const double truth = 0.199824895698387;  // Howell C-11, 1 x 1 x 1
  std::vector<double> errors;
  for (const int n : {1, 2, 4, 8}) errors.push_back(areaValue(parallelSquares(n), 512) - truth);
  expectAreaOrder(errors, 2.0, 8e-4);
}

TEST(AreaValues, SharedEdgesConvergeToSecondOrder) {
  // Seen as a whole, the wall's point value is smooth up to the shared edge (1/2 (1 - y/sqrt(1 +
  // y^2)) at distance y from a long one): order 2 again, with the shared edge no exception.
  const double truth = 0.200043776075403;  // Howell C-14, 1 x 1 x 1
  std::vector<double> errors;
  for (const int n : {1, 2, 4, 8}) {
    errors.push_back(std::abs(truth - areaValue(perpendicularRectangles(1, 1, n, n), 512)));
  }
  expectAreaOrder(errors, 2.0, 3e-4);
}

TEST(AreaValues, UnequalAreasTellRowsFromColumns) {
  // w = 1, h = 2: F from the floor is twice F from the wall. 6 x 6 patches err by about 1%, a
  // transposed matrix by a factor of 2.
  const PatchMesh mesh = perpendicularRectangles(1, 2, 6, 9);
  EXPECT_NEAR(areaValue(mesh, 256, 0, 1), 0.232852602795362, 0.02 * 0.2328);
  EXPECT_NEAR(areaValue(mesh, 256, 1, 0), 0.116426301397681, 0.02 * 0.1164);
}

TEST(AreaValues, ObstructedSquaresConverge) {
  // A thin two-sided blocker, centred in the mid-plane, side 1/2. Second order again: the kinks
  // of the shadow lie inside patches, but a midpoint rule is second order for those, too.
  const double truth = 0.0995062945990;
  std::vector<double> errors;
  for (const int n : {4, 8, 16}) {
    MeshBuilder builder;
    builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
    builder.grid("high", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, n, n);
    builder.grid("blocker", {0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0}, 1, 1, true);
    errors.push_back(std::abs(areaValue(builder.build(), 256) - truth));
    RecordProperty("error" + std::to_string(n), std::to_string(errors.back()));
  }
  // Each halving divides the error by 4; the hemicubes' own, 1e-5 here, bends that by 15%.
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.6);
  EXPECT_NEAR(errors[1] / errors[2], 4, 0.6);
  EXPECT_LT(errors[2], 1e-3 * truth);
}

TEST(AreaValues, TheUmbraSeesNoLamp) {
  // A lamp of side 0.1 at height 1 over a blocker of side 0.4 at 0.5: its umbra on the floor is
  // 0.4 + (0.4 - 0.1) = 0.7 wide. Floor patches whose centres lie in it see no lamp at all.
  MeshBuilder builder;
  builder.grid("floor", {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 20, 20);
  builder.grid("lamp", {-0.05, -0.05, 1}, {0, 0.1, 0}, {0.1, 0, 0});
  builder.grid("blocker", {-0.2, -0.2, 0.5}, {0, 0.4, 0}, {0.4, 0, 0}, 1, 1, true);
  const PatchMesh mesh = builder.build();
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 256;
  Progress silent;
  const FormFactors f = computeFormFactors(mesh, options, silent);
  int dark = 0;
  int lit = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    const Vec3 p = glm::abs(mesh.centroid[i]);
    if (p.x < 0.35 && p.y < 0.35) {
      EXPECT_EQ(f.matrix->at(i, 400), 0.0);
      ++dark;
    } else if (p.x > 0.46 || p.y > 0.46) {  // outside the penumbra, 0.4 + (0.4 + 0.1) wide
      EXPECT_GT(f.matrix->at(i, 400), 0.0);
      ++lit;
    }
  }
  EXPECT_EQ(dark, 36);
  EXPECT_EQ(lit, 300);
}

}  // namespace
}  // namespace radiosity
