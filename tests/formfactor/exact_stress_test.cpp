// Geometry that breaks form-factor programs, through both methods: nothing infinite or negative, no
// row above 1, reciprocity, and for the exact method the ground truth's values.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "exact_scenes.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "radiosity/names.h"
#include "support/mesh_builder.h"
#include "support/scene_builder.h"
#include "truth/closed_forms.h"
#include "truth/ground_truth.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using test::SceneBuilder;
using truth::Corners;

FormFactors compute(const PatchMesh& mesh, FormFactorMethod method, double tolerance = 1e-3,
                    bool simd = true) {
  FormFactorOptions options;
  options.method = method;
  options.tolerance = tolerance;
  options.resolution = 64;
  options.precision = Precision::double_precision;
  options.simd = simd;
  Progress silent;
  return computeFormFactors(mesh, options, silent);
}

/// Invariants of any row of either method.
void expectSane(const PatchMesh& mesh, const FormFactors& f, const std::string& what) {
  const bool exact = f.method == FormFactorMethod::exact;
  ASSERT_EQ(f.fronts.size(), mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    std::size_t entries = 0;
    pairsOf(*f.matrix).forRow(i, [&](Index j, double value) {
      ASSERT_TRUE(std::isfinite(value) && value >= 0) << what << " " << i << " " << j;
      sum += value;
      ++entries;
      if (exact) {
        ASSERT_NEAR(mesh.area[j] * f.matrix->at(j, i), mesh.area[i] * value,
                    4e-16 * mesh.area[i] * value)
            << what << " " << i << " " << j;
      }
    });
    ASSERT_NEAR(sum, f.fronts[i], 1e-12) << what << " " << i;
    ASSERT_GE(f.backs[i], 0.0) << what << " " << i;
    if (mesh.area[i] == 0) {
      EXPECT_EQ(f.fronts[i] + f.backs[i] + f.sky[i], 0.0) << what << " " << i;
      continue;
    }
    // The figure is the root of the sum of squares of a row's errors: their sum is at most the
    // square root of their number times it. Closed forms are good to 1e-5.
    const double allowed = exact ? 1e-5 + std::sqrt(double(entries)) * f.error[i] : 1e-12;
    EXPECT_LE(f.fronts[i] + f.backs[i], 1 + allowed) << what << " " << i;
    if (!exact) {
      EXPECT_NEAR(f.fronts[i] + f.backs[i] + f.sky[i], 1, 1e-12) << what << " " << i;
    }
  }
}

/// Both methods, and the exact one against the truth: closed forms to 2e-5 (the 1e-5 of each value
/// and the errors of storage and summing), occluded entries to `past` times the mean form factor.
/// The tolerance is 1e-3 of that, for the root mean square; the worst single entries of these
/// coarse scenes are off by 20 to 50 times as much.
void expectTrue(const PatchMesh& mesh, const std::string& what, double past = 0.05) {
  expectSane(mesh, compute(mesh, FormFactorMethod::hemicube), what + ", hemicube");
  const FormFactors f = compute(mesh, FormFactorMethod::exact);
  expectSane(mesh, f, what + ", exact");
  truth::TruthOptions options;
  options.accuracy = 1e-4;
  const truth::GroundTruth truth(mesh, options);
  const double allowed = f.report.exact.occluded > 0 ? past / double(mesh.size()) : 0.0;
  double off = 0;
  double all = 0;
  const std::size_t step = std::max<std::size_t>(1, mesh.size() / 6);
  for (std::size_t i = 0; i < mesh.size(); i += step) {
    const std::vector<double> row = truth.row(i).form_factors;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      const double value = f.matrix->at(i, j);
      EXPECT_NEAR(value, row[j], 2e-5 * row[j] + allowed + 1e-14) << what << " " << i << " " << j;
      off += mesh.area[i] * (value - row[j]) * (value - row[j]);
      all += mesh.area[i] * row[j] * row[j];
    }
  }
  // Single entries may be off by ten tolerances, and there are few in scenes as coarse as these.
  EXPECT_LE(std::sqrt(off), 1e-2 * std::sqrt(all) + 1e-14 * double(mesh.size())) << what;
}

void addRoom(SceneBuilder& builder, const Vec3& high = Vec3(1)) {
  builder.box(builder.surface("room"), Vec3(0), high, false);
}

// ---- Degenerate input

TEST(Stress, DegenerateFacesLeaveFormFactorsCorrect) {
  SceneBuilder builder;
  addRoom(builder);
  const Index odd = builder.surface("odd");
  builder.face(odd, {{0.2, 0.2, 0.5}, {0.4, 0.2, 0.5}, {0.6, 0.2, 0.5}});  // collinear
  builder.face(odd, {{0.3, 0.3, 0.3}, {0.3, 0.3, 0.3}, {0.3, 0.3, 0.3}});  // a point
  builder.face(odd, {{0.3, 0.3, 0.4}, {0.3, 0.3, 0.4}, {0.7, 0.3, 0.4}, {0.7, 0.7, 0.4}});
  for (const bool as_patches : {false, true}) {
    expectTrue(test::meshOf(builder.scene(), 60, as_patches), as_patches ? "faces" : "meshed");
  }
}

TEST(Stress, SliversOfAspectOneMillionHaveCorrectFormFactors) {
  constexpr double kThin = 1e-6;
  MeshBuilder builder;
  builder.polygon("floor", {truth::level(0, 1, 0, kThin, 0, true)});
  builder.polygon("floor", {truth::level(0, 1, kThin, 1, 0, true)});
  builder.polygon("ceiling", {truth::level(0, 1, 0, 1, 1, false)});
  builder.polygon("wall", {{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}});
  builder.polygon("near", {truth::level(0, 1, 0.5, 0.5 + kThin, kThin, false)});
  expectTrue(builder.build(), "slivers");
}

TEST(Stress, OverlappingCoplanarFacesAreRepaired) {
  SceneBuilder builder;
  addRoom(builder);
  builder.level(builder.surface("rug"), 0.2, 0.2, 0.8, 0.6, 0);
  builder.level(builder.surface("lamp", 0.5, 1), 0.3, 0.3, 0.7, 0.7, 1, false);
  expectTrue(test::meshOf(builder.scene(), 150), "overlaps");
}

// ---- Touching

TEST(Stress, HingesFromNearlyShutToNearlyFlatHaveCorrectFormFactors) {
  for (const double angle : {1e-6, 1e-4, 1e-2, 1.0, 3.0, std::numbers::pi - 1e-2,
                             std::numbers::pi - 1e-4, std::numbers::pi - 1e-6}) {
    const Vec3 up(std::cos(angle), 0, std::sin(angle));
    MeshBuilder builder;
    builder.grid("leaf", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
    builder.grid("flap", {0, 0, 0}, {0, 1, 0}, up, 2, 2);
    expectTrue(builder.build(), "hinge at " + std::to_string(angle));
  }
}

TEST(Stress, TJunctionsAndSharedCornersLeaveFormFactorsCorrect) {
  // A floor in one piece, walls and blocks that meet it at a part of its edge, in corners, and in
  // the middle of its edge.
  SceneBuilder builder;
  const Index s = builder.surface("s");
  builder.level(s, 0, 0, 2, 1, 0);
  builder.face(s, {{0, 0, 0}, {0, 0, 1}, {0.7, 0, 1}, {0.7, 0, 0}});
  builder.face(s, {{0.7, 0, 0}, {0.7, 0, 1}, {2, 0, 1}, {2, 0, 0}});
  builder.face(s, {{0, 0, 0}, {0, 0.3, 0}, {0, 0.3, 1}, {0, 0, 1}});
  builder.face(s, {{2, 1, 0}, {2, 2, 0}, {2, 2, 1}, {2, 1, 1}});
  builder.face(s, {{1, 1, 0}, {0.4, 1, 1}, {1.6, 1, 1}});
  expectTrue(test::meshOf(builder.scene(), 1, true), "T-junctions as faces");
  expectTrue(test::meshOf(builder.scene(), 40), "T-junctions meshed");
}

TEST(Stress, ABlockOnAnUncutFloorHasCorrectFormFactors) {
  SceneBuilder builder;
  addRoom(builder);
  builder.box(builder.surface("block"), Vec3(0.3, 0.35, 0), Vec3(0.6, 0.7, 0.4));
  expectTrue(test::meshOf(builder.scene(), 1, true), "standing, as faces");
  expectTrue(test::meshOf(builder.scene(), 120), "standing, meshed");
}

// ---- Solids and sheets

TEST(Stress, CrossingSolidsHaveCorrectFormFactors) {
  SceneBuilder builder;
  addRoom(builder);
  const Index solids = builder.surface("solids");
  builder.box(solids, Vec3(0.2, 0.2, 0.3), Vec3(0.6, 0.6, 0.6));
  builder.prism(solids, SceneBuilder::turnedRectangle({0.55, 0.5}, 0.5, 0.2, 0.6), 0.2, 0.5);
  expectTrue(test::meshOf(builder.scene(), 150), "crossing solids, meshed");
  expectTrue(test::meshOf(builder.scene(), 1, true), "crossing solids, as faces");
}

TEST(Stress, AFaceInsideASolidLeavesFormFactorsCorrect) {
  SceneBuilder builder;
  addRoom(builder);
  builder.box(builder.surface("solid"), Vec3(0.2), Vec3(0.7));
  builder.level(builder.surface("inner", 0.5, 0, true), 0.3, 0.3, 0.6, 0.6, 0.45);
  expectTrue(test::meshOf(builder.scene(), 1, true), "inside, as faces");
}

TEST(Stress, PatchesAlignedWithBlockersHaveCorrectFormFactors) {
  // Faces, edges and corners of the blockers in line with corners and middles of the patches.
  MeshBuilder builder;
  builder.box("room", Vec3(0), Vec3(1), 4, true);
  builder.box("block", Vec3(0.25, 0.25, 0.25), Vec3(0.5, 0.5, 0.75), 1);
  builder.grid("sheet", {0.625, 0, 0.25}, {0, 0.75, 0}, {0, 0, 0.5}, 2, 2, true);
  // Shadows all step at once, at points: the worst entries are off by 85 tolerances.
  expectTrue(builder.build(), "aligned", 0.1);
}

TEST(Stress, TwoSidedSheetsAndFlippedBoxesHaveCorrectFormFactors) {
  SceneBuilder two_sided;
  addRoom(two_sided);
  two_sided.level(two_sided.surface("sheet", 0.5, 0, true), 0.2, 0.3, 0.8, 0.7, 0.5);
  expectTrue(test::meshOf(two_sided.scene(), 120), "two-sided sheet");

  SceneBuilder flipped;
  addRoom(flipped);
  flipped.box(flipped.surface("inside out"), Vec3(0.3), Vec3(0.6), false);
  expectTrue(test::meshOf(flipped.scene(), 120), "flipped normals");
}

TEST(Stress, ABoxWithoutThicknessHasCorrectFormFactors) {
  SceneBuilder flat_box;
  addRoom(flat_box);
  flat_box.level(flat_box.surface("up"), 0.2, 0.3, 0.8, 0.7, 0.5, true);
  flat_box.level(flat_box.surface("down"), 0.2, 0.3, 0.8, 0.7, 0.5, false);
  expectTrue(test::meshOf(flat_box.scene(), 120), "box without thickness");
}

// ---- Rooms and holes

TEST(Stress, EmptyAndSinglePatchMeshesExchangeNothing) {
  for (const FormFactorMethod method : {FormFactorMethod::hemicube, FormFactorMethod::exact}) {
    const FormFactors none = compute(PatchMesh(), method);
    EXPECT_EQ(none.matrix->size(), 0u);
    MeshBuilder builder;
    builder.polygon("alone", {truth::level(0, 1, 0, 1, 0, true)});
    const PatchMesh mesh = builder.build();
    const FormFactors one = compute(mesh, method);
    expectSane(mesh, one, "single patch");
    EXPECT_EQ(pairsOf(*one.matrix).nonZeros(), 0u);
    EXPECT_EQ(one.sky[0], 1.0);
  }
}

TEST(Stress, RoomsApartSeeNothingOfEachOther) {
  MeshBuilder builder;
  builder.box("left", Vec3(0), Vec3(1), 3, true);
  builder.box("right", Vec3(1.5, 0, 0), Vec3(2.5, 1, 1), 3, true);
  const PatchMesh mesh = builder.build();
  expectTrue(mesh, "two rooms apart");
  const FormFactors f = compute(mesh, FormFactorMethod::exact);
  EXPECT_TRUE(f.report.closed);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    pairsOf(*f.matrix).forRow(
        i, [&](Index j, double) { EXPECT_EQ(mesh.surface[i], mesh.surface[j]); });
  }
}

TEST(Stress, APinholeLeavesFormFactorsCorrect) {
  // A wall with a hole of 1e-4 between two rooms.
  constexpr double kHole = 1e-4;
  const double a = 0.5 - kHole / 2;
  const double b = 0.5 + kHole / 2;
  SceneBuilder builder;
  builder.box(builder.surface("shell"), Vec3(0), Vec3(2, 1, 1), false);
  const Index wall = builder.surface("wall", 0.5, 0, true);
  const auto piece = [&](double y0, double y1, double z0, double z1) {
    builder.face(wall, {{1, y0, z0}, {1, y1, z0}, {1, y1, z1}, {1, y0, z1}});
  };
  piece(0, 1, 0, a);
  piece(0, 1, b, 1);
  piece(0, a, a, b);
  piece(b, 1, a, b);
  const PatchMesh mesh = test::meshOf(builder.scene(), 1, true);
  for (const FormFactorMethod method : {FormFactorMethod::hemicube, FormFactorMethod::exact}) {
    const FormFactors f = compute(mesh, method);
    expectSane(mesh, f, "pinhole");
  }
  // 1e-8 of all light goes through, far below the tolerance: ten of them, 1e-2 / N.
  const truth::GroundTruth truth(mesh);
  const FormFactors f = compute(mesh, FormFactorMethod::exact);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      EXPECT_NEAR(f.matrix->at(i, j), truth.formFactor(i, j), 2e-5 + 1e-2 / double(mesh.size()))
          << i << " " << j;
    }
  }
}

TEST(Stress, ConcavePolygonsAndHolesHaveCorrectFormFactors) {
  SceneBuilder builder;
  addRoom(builder, Vec3(2, 2, 1));
  const Index s = builder.surface("concave", 0.5, 0, true);
  // A U, a star, and a plate in four faces about a hole.
  builder.face(s, {{0.2, 0.2, 0.5},
                   {1.0, 0.2, 0.5},
                   {1.0, 0.9, 0.5},
                   {0.8, 0.9, 0.5},
                   {0.8, 0.4, 0.5},
                   {0.4, 0.4, 0.5},
                   {0.4, 0.9, 0.5},
                   {0.2, 0.9, 0.5}});
  std::vector<Vec3> star;
  for (int k = 0; k < 10; ++k) {
    const double r = k % 2 == 0 ? 0.4 : 0.15;
    const double t = 2 * std::numbers::pi * k / 10;
    star.emplace_back(1.5 + r * std::cos(t), 0.6 + r * std::sin(t), 0.3);
  }
  builder.face(s, star);
  builder.level(s, 0.5, 1.1, 1.5, 1.3, 0.6);
  builder.level(s, 0.5, 1.6, 1.5, 1.8, 0.6);
  builder.level(s, 0.5, 1.3, 0.8, 1.6, 0.6);
  builder.level(s, 1.2, 1.3, 1.5, 1.6, 0.6);
  expectTrue(test::meshOf(builder.scene(), 80), "concave, meshed");
  expectTrue(test::meshOf(builder.scene(), 1, true), "concave, as faces");
}

TEST(Stress, AThousandBlockersHideHalfOfAPatch) {
  // The black fields of a board of 46 x 46 half-way between two plates pass the light that the
  // white ones block, and are their mirror image: half of everything.
  constexpr int kFields = 46;
  MeshBuilder builder;
  builder.polygon("lower", {truth::level(0, 1, 0, 1, 0, true)});
  builder.polygon("upper", {truth::level(0, 1, 0, 1, 1, false)});
  const auto at = [](int k) { return double(k) / kFields; };
  for (int x = 0; x < kFields; ++x) {
    for (int y = x % 2; y < kFields; y += 2) {
      builder.polygon("field", {truth::level(at(x), at(x + 1), at(y), at(y + 1), 0.5, true)});
    }
  }
  const PatchMesh mesh = builder.build();
  const FormFactors f = compute(mesh, FormFactorMethod::exact);
  expectSane(mesh, f, "board");
  // The tolerance of the default options, relative to the mean form factor of two patches.
  EXPECT_NEAR(f.matrix->at(0, 1), 0.5 * 0.199824895698387, 1e-3 * 0.5);
}

// ---- Invariance

PatchMesh transformed(PatchMesh mesh, double scale, const Vec3& shift, double turn) {
  const Vec3 axis = glm::normalize(Vec3(1, 2, 3));
  const auto direction = [&](const Vec3& n) { return test::rotated(n, axis, turn); };
  const auto point = [&](const Vec3& p) { return direction(p) * scale + shift; };
  for (Vec3& p : mesh.vertices) p = point(p);
  for (Vec3& p : mesh.centroid) p = point(p);
  for (Vec3& p : mesh.polygons.origin) p = point(p);
  for (Vec3& n : mesh.normal) n = direction(n);
  for (Vec3& n : mesh.polygons.normal) n = direction(n);
  for (double& a : mesh.area) a *= scale * scale;
  return mesh;
}

double largestDifference(const FormFactors& a, const FormFactors& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.fronts.size(); ++i) {
    for (std::size_t j = 0; j < a.fronts.size(); ++j) {
      most = std::max(most, std::abs(a.matrix->at(i, j) - b.matrix->at(i, j)));
    }
  }
  return most;
}

/// A room with turned boxes that block each other: no critical line through a patch's corner by
/// construction, unlike in a room of aligned boxes.
PatchMesh turnedBoxes() {
  SceneBuilder builder;
  addRoom(builder, Vec3(1.1, 0.9, 1));
  const Index boxes = builder.surface("boxes");
  builder.prism(boxes, SceneBuilder::turnedRectangle({0.35, 0.4}, 0.3, 0.2, 0.4), 0.1, 0.55);
  builder.prism(boxes, SceneBuilder::turnedRectangle({0.73, 0.57}, 0.2, 0.25, 1.1), 0.3, 0.8);
  return test::meshOf(builder.scene(), 150);
}

/// Two plates with a turned sheet between them.
PatchMesh turnedObstacle() {
  Corners sheet;
  for (const Vec2& p : SceneBuilder::turnedRectangle({0.45, 0.52}, 0.4, 0.3, 0.4)) {
    sheet.emplace_back(p.x, p.y, 0.4 + 0.1 * p.x);
  }
  return truth::blockedPlates({sheet}, 3);
}

TEST(Sameness, PlaceScaleAndTurnKeepExactValues) {
  // Far closed forms and shadows are computed in single precision if the tolerance allows: rounded
  // coordinates then show, by some 1e-7 of a form factor. Else 1e-9.
  const struct {
    PatchMesh mesh;
    double tolerance, allowed;
  } cases[] = {{turnedBoxes(), 1e-3, 1e-7}, {turnedObstacle(), 1e-6, 1e-9}};
  for (const auto& c : cases) {
    const PatchMesh& mesh = c.mesh;
    const auto run = [&](const PatchMesh& m) {
      return compute(m, FormFactorMethod::exact, c.tolerance);
    };
    const FormFactors plain = run(mesh);
    EXPECT_GT(plain.report.exact.occluded, 50u);
    for (const double scale : {1e-6, 0.3, 1e6}) {
      const PatchMesh scaled = transformed(mesh, scale, Vec3(0.0), 0);
      EXPECT_LT(largestDifference(plain, run(scaled)), c.allowed) << scale;
    }
    const PatchMesh turned = transformed(mesh, 1, Vec3(0.0), 1);
    EXPECT_LT(largestDifference(plain, run(turned)), c.allowed);
    // Coordinates near 1e6 are multiples of 1.2e-10: the moved scene is another one by that much,
    // over patches of a tenth of the scene.
    const PatchMesh moved = transformed(mesh, 1, Vec3(1e6, -1e6, 1e6), 0);
    EXPECT_LT(largestDifference(plain, run(moved)), 5 * c.allowed);
  }
}

TEST(Sameness, NoBitDependsOnThreadsVectorsOrPowersOfTwo) {
  for (const FormFactorMethod method : {FormFactorMethod::hemicube, FormFactorMethod::exact}) {
    const PatchMesh mesh = turnedBoxes();
    const FormFactors plain = compute(mesh, method);
    setThreads(1);
    EXPECT_EQ(largestDifference(plain, compute(mesh, method)), 0)
        << nameOf(kFactorsFromNames, plain.method);
    setThreads(3);
    EXPECT_EQ(largestDifference(plain, compute(mesh, method)), 0)
        << nameOf(kFactorsFromNames, plain.method);
    setThreads(0);
    EXPECT_EQ(largestDifference(plain, compute(mesh, method, 1e-3, false)), 0)
        << nameOf(kFactorsFromNames, plain.method);
    for (const double scale : {0x1p-40, 0x1p33}) {
      const PatchMesh scaled = transformed(mesh, scale, Vec3(0.0), 0);
      EXPECT_EQ(largestDifference(plain, compute(scaled, method)), 0)
          << nameOf(kFactorsFromNames, plain.method) << scale;
    }
  }
}

TEST(Sameness, NoBitOfTightTolerancesDependsOnVectors) {
  // The double-precision kernels, which tight tolerances use, in vectors and one by one.
  const PatchMesh mesh = test::roomWithBlock(2).build();
  EXPECT_EQ(largestDifference(compute(mesh, FormFactorMethod::exact, 1e-5),
                              compute(mesh, FormFactorMethod::exact, 1e-5, false)),
            0);
}

// ---- Absent features cost nothing

TEST(ExactSkips, ConvexAndCoplanarScenesRunNoVisibility) {
  MeshBuilder plain;
  plain.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 100, 100);
  const ExactReport flat = compute(plain.build(), FormFactorMethod::exact).report.exact;
  EXPECT_EQ(flat.elements, 10000u);
  EXPECT_EQ(flat.unoccluded + flat.hidden + flat.occluded, 0u);
  EXPECT_EQ(flat.facet_pairs + flat.shaft_tests + flat.contour + flat.lambert + flat.product, 0u);

  SceneBuilder octahedron;
  const Index s = octahedron.surface("octahedron");
  for (const double x : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      for (const double z : {1.0, -1.0}) {
        std::vector<Vec3> c = {{x, 0, 0}, {0, y, 0}, {0, 0, z}};
        if (x * y * z > 0) std::swap(c[1], c[2]);
        octahedron.face(s, c);
      }
    }
  }
  const PatchMesh mesh = test::meshOf(octahedron.scene(), 500);
  const FormFactors f = compute(mesh, FormFactorMethod::exact);
  EXPECT_EQ(f.report.exact.shaft_tests + f.report.exact.occluded + f.report.exact.hidden, 0u);
  EXPECT_EQ(f.report.exact.occluders, 0u);
  for (const double sum : f.fronts) EXPECT_NEAR(sum, 1, 2e-5);
}

/// A room of 1 m with a box floating in it, of triangles; every corner of each is moved by up to
/// `noise` of the diagonal along each axis.
Scene noisyRoom(double noise, unsigned seed) {
  SceneBuilder whole;
  whole.box(whole.surface("room"), {0, 0, 0}, {1, 1, 1}, false);
  whole.box(whole.surface("block"), {0.3, 0.3, 0.1}, {0.7, 0.7, 0.5});
  const Scene& plain = whole.scene();
  SceneBuilder out;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-noise * std::sqrt(3.0), noise * std::sqrt(3.0));
  for (const Surface& surface : plain.surfaces) out.surface(surface.object);
  for (std::size_t f = 0; f < plain.faceCount(); ++f) {
    const auto face = plain.face(f);
    for (std::size_t k = 2; k < face.size(); ++k) {
      std::vector<Vec3> corners;
      for (const Index v : {face[0], face[k - 1], face[k]}) {
        corners.push_back(plain.vertices[v] + Vec3(shift(random), shift(random), shift(random)));
      }
      out.face(plain.face_surface[f], corners);
    }
  }
  return seed % 2 == 0 ? out.scene() : test::turned(out.scene());
}

TEST(ExactStress, NoiseOnCornersLeavesNoPatchOfRounding) {
  for (const double noise : {3e-8, 1e-7, 1.5e-7, 1e-6}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::to_string(noise * 1e9) + " nm, seed " + std::to_string(seed));
      MeshOptions options;
      options.patches = 80;
      Progress silent;
      const PatchMesh mesh = meshScene(noisyRoom(noise, seed), options, silent).mesh;
      const FormFactors f = compute(mesh, FormFactorMethod::exact);
      double area = 0;
      double seen = 0;
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        pairsOf(*f.matrix).forRow(i, [&](Index, double value) { ASSERT_GE(value, 0.0) << i; });
        // Without noise the largest is .004, and of strips as thin as a few coincidences .025. A
        // patch as thin as rounding has .1 to 2. (Gaps wider than four coincidences are strips of
        // their own, with errors of their own: with noise of 1.5 coincidences 4 rooms of 16 have
        // one.)
        if (noise < 1.2e-7) {
          EXPECT_LT(f.error[i], 0.05) << i;
        }
        if (mesh.surface_names[mesh.surface[i]] != "block/block") continue;
        area += mesh.area[i];
        seen += mesh.area[i] * f.fronts[i];
      }
      // A convex block in a room sees the room alone. Gaps let out a share of a few times the
      // noise; the tolerance of 1e-3 of a mean factor, over the root of 80 patches, is 1e-4.
      EXPECT_NEAR(area, 6 * 0.16, 100 * noise);
      EXPECT_NEAR(seen / area, 1, 2e-4 + 100 * noise);
    }
  }
}

}  // namespace
}  // namespace radiosity
