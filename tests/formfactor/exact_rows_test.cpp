// Exact rows of emitters beside rows by rays or hemicubes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "formfactor/computed_factors.h"
#include "formfactor/exact_scenes.h"
#include "radiosity/exchange_matrix.h"
#include "radiosity/form_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

FormFactors byRays(const PatchMesh& mesh, const std::vector<Index>& exact_rows, double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::rays;
  options.tolerance = tolerance;
  options.exact_rows = exact_rows;
  return test::computed(mesh, options);
}

FormFactors byHemicubes(const PatchMesh& mesh, const std::vector<Index>& exact_rows) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 64;
  options.exact_rows = exact_rows;
  return test::computed(mesh, options);
}

/// The share of some patches in the view of patch i.
double shareOf(const FormFactors& factors, std::size_t i, const std::vector<Index>& seen) {
  double sum = 0;
  for (const Index e : seen) sum += factors.matrix->at(i, e);
  return sum;
}

/// The share of some patches that each patch sees, over its true value: the largest difference, of
/// patches that see a hundredth of the mean or more.
double worstShare(const FormFactors& found, const FormFactors& truth,
                  const std::vector<Index>& seen) {
  const std::size_t n = truth.matrix->size();
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) mean += shareOf(truth, i, seen) / double(n);
  double worst = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double is = shareOf(truth, i, seen);
    if (is >= 0.01 * mean) worst = std::max(worst, std::abs(shareOf(found, i, seen) / is - 1));
  }
  return worst;
}

class ExactRows : public testing::TestWithParam<const char*> {};

TEST_P(ExactRows, GiveDirectLightThatRaysAloneMiss) {
  const Scene scene = test::dataScene(GetParam());
  const PatchMesh mesh = test::meshOf(scene, 300);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  ASSERT_FALSE(emitters.empty());
  const FormFactors truth = test::computed(mesh, test::exactly(1e-4));
  constexpr double kTolerance = 5e-2;
  const FormFactors rays = byRays(mesh, {}, kTolerance);
  const FormFactors both = byRays(mesh, emitters, kTolerance);
  EXPECT_FALSE(rays.report.exact_rows);
  EXPECT_EQ(both.report.exact_rows, emitters.size());
  // No patch's direct light is to be off by more than this, whatever the tolerance.
  EXPECT_GT(worstShare(rays, truth, emitters), 0.05);
  EXPECT_LT(worstShare(both, truth, emitters), 0.05);
  EXPECT_LT(both.report.error_figure, kTolerance);
  for (const Index e : emitters) {
    double square = 0;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      square += std::pow(both.matrix->at(e, j) - truth.matrix->at(e, j), 2);
    }
    // The truth has a figure, too; single precision rounds to 6e-8.
    EXPECT_LE(std::sqrt(square), both.error[e] + truth.error[e] + 1e-7);
    EXPECT_LT(both.error[e], 0.2 * rays.error[e]);
  }
}

TEST_P(ExactRows, GiveDirectLightThatHemicubesMiss) {
  const Scene scene = test::dataScene(GetParam());
  const PatchMesh mesh = test::meshOf(scene, 300);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  const FormFactors truth = test::computed(mesh, test::exactly(1e-4));
  const FormFactors seen = byHemicubes(mesh, {});
  const FormFactors both = byHemicubes(mesh, emitters);
  EXPECT_FALSE(seen.report.exact_rows);
  EXPECT_EQ(both.report.exact_rows, emitters.size());
  EXPECT_GT(worstShare(seen, truth, emitters), 0.05);
  EXPECT_LT(worstShare(both, truth, emitters), 0.05);
  std::vector<std::uint8_t> emits(mesh.size(), 0);
  for (const Index e : emitters) emits[e] = 1;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    EXPECT_NEAR(both.fronts[i] + both.backs[i] + both.sky[i], 1, 1e-12);
    if (emits[i] != 0) continue;
    EXPECT_NEAR(both.matrix->rowSums()[i], both.fronts[i], 1e-7);  // single precision
    // All else that was seen keeps its proportions, backs and sky with the rest.
    const double rest_seen = 1 - shareOf(seen, i, emitters);
    const double rest_both = 1 - shareOf(both, i, emitters);
    pairsOf(*seen.matrix).forRow(i, [&](Index j, double value) {
      if (emits[j] == 0) {
        EXPECT_NEAR(both.matrix->at(i, j) / value, rest_both / rest_seen, 1e-6) << i << " " << j;
      }
    });
    EXPECT_NEAR(both.sky[i] * rest_seen, seen.sky[i] * rest_both, 1e-7);
  }
}

TEST_P(ExactRows, StayExactInAMergedMatrix) {
  const Scene scene = test::dataScene(GetParam());
  const PatchMesh mesh = test::meshOf(scene, 300);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 64;
  options.exact_rows = emitters;
  const FormFactors raw = test::computed(mesh, options);
  options.symmetrize = true;
  const FormFactors merged = test::computed(mesh, options);
  for (const Index e : emitters) {
    pairsOf(*raw.matrix).forRow(e, [&](Index j, double value) {
      // Closed rows are scaled to their sum, columns are not: by 1e-3 at most, the rows' tolerance.
      EXPECT_NEAR(merged.matrix->at(e, j) / value, 1, 1e-3) << e << " " << j;
    });
  }
}

TEST_P(ExactRows, OfTheExactMethodGiveDimReceiversTheirLight) {
  const Scene scene = test::dataScene(GetParam());
  const PatchMesh mesh = test::meshOf(scene, 300);
  const std::vector<Index> emitters = emittingPatches(mesh, patchMaterials(scene, mesh));
  const FormFactors truth = test::computed(mesh, test::exactly(1e-5));
  FormFactorOptions options = test::exactly(1e-3);
  const FormFactors beside_rows = test::computed(mesh, options);
  options.exact_rows = emitters;
  const FormFactors itself = test::computed(mesh, options);
  EXPECT_GT(worstShare(beside_rows, truth, emitters), 0.05);
  EXPECT_LT(worstShare(itself, truth, emitters), 0.05);
}

TEST_P(ExactRows, KeepClosureAndReciprocity) {
  const Scene scene = test::dataScene(GetParam());
  const PatchMesh mesh = test::meshOf(scene, 300);
  const FormFactors f = byRays(mesh, emittingPatches(mesh, patchMaterials(scene, mesh)), 2e-2);
  EXPECT_TRUE(f.matrix->isSymmetric());
  const std::vector<double> sums = f.matrix->rowSums();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (!(mesh.area[i] > 0)) continue;
    // What is left is sky; where closure has left less than nothing, sky is 0. Rows are closed to
    // 1e-9, then rounded as stored: single precision, 6e-8 of each value.
    const double accounts = f.fronts[i] + f.backs[i] + f.sky[i];
    EXPECT_NEAR(accounts, 1, f.sky[i] > 0 ? 1e-12 : 1e-7);
    EXPECT_NEAR(sums[i], f.fronts[i], 1e-7);  // single precision: 6e-8 of each value
    if (f.report.closed) {
      EXPECT_NEAR(sums[i] + f.backs[i], 1, 1e-7);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactRows,
                         testing::Values("cornell-box-closed", "two-rooms", "cornell-box"));

TEST(ExactRowsOfTheOpen, TellSkyAndBacksFromFronts) {
  // A floor below a smaller plate that turns its black back down, in the open.
  test::MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  builder.grid("plate", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1, 1);
  const PatchMesh mesh = builder.build();
  for (const FormFactors& f : {byRays(mesh, {0, 1, 2, 3}, 1e-1), byHemicubes(mesh, {0, 1, 2, 3})}) {
    double backs = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(f.fronts[i], 0);
      EXPECT_NEAR(f.backs[i] + f.sky[i], 1, 1e-12);
      backs += f.backs[i] / 4;
    }
    // Two unit squares one apart, as the faces of a cube (Howell, "A Catalog of Radiation
    // Configuration Factors", C-11); closed forms hold 1e-5.
    EXPECT_NEAR(backs, 0.199824895698, 1e-5 * 0.2);
  }
}

TEST(ExactRowsOfARoom, HaveTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  setThreads(1);
  const FormFactors one = byRays(mesh, {0, 5, 11}, 5e-2);
  setThreads(0);
  const FormFactors all = byRays(mesh, {0, 5, 11}, 5e-2);
  EXPECT_EQ(one.error, all.error);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      ASSERT_EQ(one.matrix->at(i, j), all.matrix->at(i, j));
    }
  }
}

TEST(ExactRowsOptions, AreRefusedUnlessTheyAreDistinctPatches) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  EXPECT_THROW(byRays(mesh, {Index(mesh.size())}, 5e-2), InputError);
  EXPECT_THROW(byRays(mesh, {3, 3}, 5e-2), InputError);
}

}  // namespace
}  // namespace radiosity
