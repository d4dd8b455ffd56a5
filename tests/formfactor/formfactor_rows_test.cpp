// Rows of the form-factor matrix: their accounts and their invariance.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <regex>

#include "formfactor/computed_factors.h"
#include "formfactor/hemicube/row_builder.h"
#include "radiosity/form_factors.h"
#include "radiosity/matrix_functions.h"
#include "support/mesh_builder.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

FormFactorOptions hemicubes() {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  return options;
}

FormFactorOptions doublePrecision(int resolution) {
  FormFactorOptions options = hemicubes();
  options.resolution = resolution;
  options.precision = Precision::double_precision;
  return options;
}

/// The matrix, entry for entry, as it would be if patch order[k] were patch k.
void expectSameRows(const FormFactors& a, const FormFactors& b,
                    const std::vector<std::size_t>& order = {}) {
  ASSERT_EQ(a.fronts.size(), b.fronts.size());
  const auto in_a = [&](std::size_t k) { return order.empty() ? k : order[k]; };
  for (std::size_t i = 0; i < b.fronts.size(); ++i) {
    EXPECT_EQ(a.fronts[in_a(i)], b.fronts[i]);
    EXPECT_EQ(a.backs[in_a(i)], b.backs[i]);
    EXPECT_EQ(a.sky[in_a(i)], b.sky[i]);
    for (std::size_t j = 0; j < b.fronts.size(); ++j) {
      ASSERT_EQ(a.matrix->at(in_a(i), in_a(j)), b.matrix->at(i, j)) << i << " " << j;
    }
  }
}

TEST(Rows, FurnaceIsExactInAClosedRoomWithABlock) {
  // With rows that sum to 1, E = 1 and rho = 1/2 give B = 2 everywhere: one row product of the
  // constant 2 returns 2. The row's accounts are sums of at most a few thousand terms below 1.
  const PatchMesh mesh = test::roomWithBlock(3).build();
  const FormFactors f = test::computed(mesh, doublePrecision(64));
  EXPECT_TRUE(f.report.closed);
  EXPECT_LE(f.report.largest_row_error, 1e-12);
  const std::vector<double> constant(mesh.size(), 2.0);
  std::vector<double> irradiance(mesh.size());
  f.matrix->product(constant, 1, irradiance);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_NEAR(1 + 0.5 * irradiance[i], 2.0, 1e-12) << i;
    EXPECT_EQ(f.sky[i], 0.0);
    EXPECT_EQ(f.backs[i], 0.0);
  }
}

TEST(Rows, NoPixelLeaksOutOfAClosedScene) {
  // Thousands of random eyes and turns, every pixel: a single crack between polygons would show
  // as sky. 16-pixel faces put many centres close to edges.
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const ViewScene scene(mesh);
  const DeltaFormFactors weights(32);
  Hemicube hemicube(scene, weights, rasterKernels(true));
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int k = 0; k < 3000; ++k) {
    Vec3 eye(unit(random), unit(random), unit(random));
    if (eye.x > 0.3 && eye.x < 0.6 && eye.y > 0.3 && eye.y < 0.6 && eye.z < 0.45) eye.z += 0.5;
    const Vec3 normal =
        glm::normalize(Vec3(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5));
    const HemicubeView& view =
        hemicube.look(eyeFrame(eye * scene.scale, normal, 7 * unit(random)), kNone, nullptr);
    ASSERT_EQ(view.sky, 0.0) << k;
    ASSERT_NEAR(view.fronts + view.backs, 1.0, 1e-12);
  }
}

TEST(Rows, SymmetricEyesWithoutTurnsDoNotLeak) {
  // Edges through pixel centres, exactly edge-on polygons: the cases random turns avoid.
  MeshBuilder builder;
  builder.box("room", {-1, -1, -1}, {1, 1, 1}, 5, true);
  builder.box("block", {-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}, 2);
  FormFactorOptions options = doublePrecision(16);
  options.random_turns = false;
  const FormFactors f = test::computed(builder.build(), options);
  EXPECT_TRUE(f.report.closed);
  for (const double backs : f.backs) EXPECT_EQ(backs, 0.0);
}

TEST(Rows, OfAnOpenSceneAccountForSkyAndBacks) {
  // Two facing unit squares, gap 1, a third one seen from behind beside them.
  MeshBuilder builder;
  builder.grid("low", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  builder.grid("high", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2, 2);
  builder.grid("flipped", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 2, 2);  // faces away from the others
  const PatchMesh mesh = builder.build();
  const FormFactors f = test::computed(mesh, doublePrecision(128));
  EXPECT_FALSE(f.report.closed);
  EXPECT_LE(f.report.largest_row_error, 1e-12);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_GT(f.backs[i], 0.05);
    EXPECT_GT(f.sky[i], 0.1);
  }
  double area_weighted = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    area_weighted += mesh.area[i] * f.backs[i];
    area += mesh.area[i];
  }
  EXPECT_NEAR(f.backs_by_surface[2], area_weighted / area, 1e-14);
  EXPECT_EQ(f.backs_by_surface[0], 0.0);
  ASSERT_EQ(f.report.notes.size(), 1u);
  EXPECT_NE(f.report.notes[0].text.find("flipped"), std::string::npos);
  EXPECT_NE(f.report.notes[0].text.find("flipped (", 0), std::string::npos);
}

TEST(Rows, TheWarningOfBacksNamesThreeOfManySurfaces) {
  // Twenty boards above a floor, facing up, too: none makes up a tenth of the floor's view.
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1);
  for (int k = 0; k < 20; ++k) {
    const double x = 0.05 * k;
    builder.grid("board " + std::to_string(k), {x, 0, 0.5}, {0.05, 0, 0}, {0, 1, 0}, 1, 1);
  }
  const FormFactors f = test::computed(builder.build(), doublePrecision(64));
  ASSERT_EQ(f.report.notes.size(), 2u);  // the other: no surface sees the front of another
  const std::string text = f.report.notes[0].text + '\n' + f.report.notes[1].text;
  EXPECT_TRUE(std::regex_search(
      text, std::regex(R"(: (board \d+ \(\d\.\d\d%\)(, )?){3} and 17 more; flipped)")))
      << text;
}

TEST(Rows, TwoSidedPolygonsAreSeenFromBothSides) {
  // A plate between a floor and a ceiling: the floor sees its back patches, never its fronts.
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  builder.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 2, 2);
  builder.grid("plate", {0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0}, 2, 2, true);
  const PatchMesh mesh = builder.build();
  ASSERT_EQ(mesh.size(), 16u);
  const FormFactors f = test::computed(mesh, doublePrecision(256));
  for (std::size_t i = 0; i < 4; ++i) {
    double to_fronts = 0;
    double to_backs = 0;
    double up = 0;
    for (std::size_t j = 8; j < 12; ++j) to_fronts += f.matrix->at(i, j);
    for (std::size_t j = 12; j < 16; ++j) to_backs += f.matrix->at(i, j);
    for (std::size_t j = 12; j < 16; ++j) up += f.matrix->at(j, i);
    EXPECT_EQ(to_fronts, 0.0);
    EXPECT_GT(to_backs, 0.1);
    EXPECT_GT(up, 0.1);
    EXPECT_EQ(f.backs[i], 0.0);
  }
}

TEST(Rows, DegeneratePatchesHaveEmptyRows) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 2, true);
  PatchMesh mesh = builder.build();
  mesh.area[5] = 0;
  mesh.polygon[5] = kNone;
  mesh.normal[5] = Vec3(0.0);
  const FormFactors f = test::computed(mesh, doublePrecision(32));
  EXPECT_EQ(f.report.empty_rows, 1u);
  EXPECT_EQ(f.report.hemicube.hemicubes, 23u);
  EXPECT_EQ(f.fronts[5], 0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_EQ(f.matrix->at(5, i), 0.0);
    EXPECT_EQ(f.matrix->at(i, 5), 0.0);
  }
}

TEST(Rows, ScalingByAPowerOfTwoChangesNoBit) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  const FormFactors f = test::computed(mesh, doublePrecision(64));
  for (const int exponent : {-20, -1, 3, 20}) {
    PatchMesh scaled = mesh;
    for (Vec3& v : scaled.vertices) v *= std::ldexp(1.0, exponent);
    for (Vec3& v : scaled.centroid) v *= std::ldexp(1.0, exponent);
    for (Vec3& v : scaled.polygons.origin) v *= std::ldexp(1.0, exponent);
    for (double& a : scaled.area) a *= std::ldexp(1.0, 2 * exponent);
    expectSameRows(f, test::computed(scaled, doublePrecision(64)));
  }
}

TEST(Rows, ThreadCountAndScalarTargetChangeNoBit) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  const FormFactors f = test::computed(mesh, doublePrecision(64));
  setThreads(1);
  expectSameRows(f, test::computed(mesh, doublePrecision(64)));
  setThreads(0);
  FormFactorOptions scalar = doublePrecision(64);
  scalar.simd = false;
  const FormFactors by_scalars = test::computed(mesh, scalar);
  EXPECT_EQ(by_scalars.report.simd_target, test::scalarTarget());
  EXPECT_NE(f.report.simd_target, test::scalarTarget());
  expectSameRows(f, by_scalars);
}

TEST(Rows, PermutationOfPatchesChangesNoBit) {
  const MeshBuilder builder = test::roomWithBlock(2);
  const PatchMesh mesh = builder.build();
  std::vector<std::size_t> order(mesh.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937_64(3));
  const FormFactors f = test::computed(mesh, doublePrecision(64));
  const FormFactors permuted = test::computed(builder.build(order), doublePrecision(64));
  expectSameRows(f, permuted, order);
  EXPECT_EQ(f.backs_by_surface, permuted.backs_by_surface);
}

TEST(Rows, SeedTurnsTheHemicubes) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  FormFactorOptions options = doublePrecision(32);
  const FormFactors f = test::computed(mesh, options);
  options.seed = 2;
  EXPECT_NE(f.matrix->at(0, 8), test::computed(mesh, options).matrix->at(0, 8));
}

TEST(Rows, MemoryLimitRefusesWithTheNumbers) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  FormFactorOptions options = doublePrecision(32);
  options.memory_limit = 1000;
  try {
    test::computed(mesh, options);
    FAIL() << "no error";
  } catch (const RunError& error) {
    EXPECT_NE(std::string(error.what()).find("limit"), std::string::npos) << error.what();
  }
  Progress silent;
  options.memory_limit = planFormFactors(mesh, options, silent).bytes;
  EXPECT_GE(options.memory_limit, test::computed(mesh, options).report.matrix_bytes);
}

TEST(Rows, OptionsHaveValidDefaultsAndRanges) {
  EXPECT_NO_THROW(FormFactorOptions().validate());
  for (const int bad : {0, 14, 17, 4098, -16}) {
    FormFactorOptions options;
    options.method = FormFactorMethod::hemicube;
    options.resolution = bad;
    EXPECT_THROW(options.validate(), InputError) << bad;
  }
}

TEST(Rows, CancellingStopsTheRun) {
  class CancelAtOnce : public Progress {
   public:
    void advance(std::size_t /*steps*/) override { cancel(); }
  } progress;
  EXPECT_THROW(computeFormFactors(test::roomWithBlock(2).build(), doublePrecision(32), progress),
               Cancelled);
}

TEST(Rows, SymmetrizeMergesBothEndsAndKeepsRowSums) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  FormFactorOptions options = doublePrecision(128);
  const FormFactors raw = test::computed(mesh, options);
  options.symmetrize = true;
  const FormFactors f = test::computed(mesh, options);
  EXPECT_TRUE(f.report.symmetrized);
  EXPECT_GT(raw.report.reciprocity_residual, 1e-3);  // one point a patch: the ends differ
  EXPECT_EQ(f.report.reciprocity_residual, raw.report.reciprocity_residual);
  EXPECT_LE(reciprocityResidual(pairsOf(*f.matrix)), 1e-14);  // rounding of one product
  for (const double sum : f.matrix->rowSums()) EXPECT_NEAR(sum, 1.0, 1e-11);
  for (const double fronts : f.fronts) EXPECT_NEAR(fronts, 1.0, 1e-11);
}

}  // namespace
}  // namespace radiosity
