// Form factors by rays against published values, against the exact method, and against themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "formfactor/computed_factors.h"
#include "formfactor/exact_scenes.h"
#include "formfactor/rays/ray_rounds.h"
#include "formfactor/rays/ray_scene.h"
#include "radiosity/form_factors.h"
#include "radiosity/matrix_functions.h"
#include "support/mesh_builder.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

FormFactorOptions byRays(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::rays;
  options.tolerance = tolerance;
  return options;
}

/// The errors of rows against true ones.
struct Score {
  std::size_t rows = 0;
  std::size_t below_figure = 0;
  double largest = 0;  ///< relL2 of a row
  double all = 0;      ///< area-weighted relL2 of F
};

Score score(const FormFactors& rays, const FormFactors& truth) {
  Score result;
  double squares = 0;
  double norms = 0;
  const std::size_t n = truth.matrix->size();
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<double> row(n, 0.0);
    double norm = 0;
    pairsOf(*truth.matrix).forRow(i, [&](Index j, double value) {
      row[j] = value;
      norm += value * value;
    });
    if (norm == 0) continue;
    pairsOf(*rays.matrix).forRow(i, [&](Index j, double value) { row[j] -= value; });
    double square = 0;
    for (const double difference : row) square += difference * difference;
    squares += truth.matrix->area()[i] * square;
    norms += truth.matrix->area()[i] * norm;
    result.largest = std::max(result.largest, std::sqrt(square / norm));
    ++result.rows;
    result.below_figure += std::sqrt(square) <= rays.error[i] ? 1 : 0;
  }
  result.all = std::sqrt(squares / norms);
  return result;
}

TEST(Rays, FindTheFormFactorsOfACube) {
  // Opposite and adjoining faces of a cube (Howell, "A Catalog of Radiation Configuration Factors",
  // C-11 and C-14).
  constexpr double kOpposite = 0.199824895698;
  constexpr double kAdjoining = 0.200043776075;
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 1, true);
  const PatchMesh mesh = builder.build();
  const FormFactors f = test::computed(mesh, byRays(1e-4));
  ASSERT_EQ(mesh.size(), 6u);
  EXPECT_TRUE(f.report.closed);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      if (i == j) continue;
      const bool opposite = glm::dot(mesh.normal[i], mesh.normal[j]) < -0.5;
      EXPECT_NEAR(f.matrix->at(i, j), opposite ? kOpposite : kAdjoining, f.error[i]);
    }
    // A useful figure is small: the row's norm is .45, good to 1e-4, and so few entries and rows
    // cost a factor of up to 6 (the root of the 99% quantile of F(1, 3)).
    EXPECT_LT(f.error[i], 6 * 1e-4 * 0.45);
  }
}

TEST(Rays, KeepReciprocityAndClosure) {
  const PatchMesh mesh = test::roomWithBlock(4).build();
  const FormFactors f = test::computed(mesh, byRays(2e-2));
  EXPECT_TRUE(f.matrix->isSymmetric());
  EXPECT_TRUE(f.report.closed);
  const std::vector<double> sums = f.matrix->rowSums();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    // Values are stored in single precision: 6e-8 of each.
    EXPECT_NEAR(sums[i] + f.backs[i], 1, 1e-7);
    EXPECT_EQ(f.sky[i], 0);
  }
}

class RaysAgainstExact : public testing::TestWithParam<const char*> {};

TEST_P(RaysAgainstExact, RowsKeepTheToleranceAndTheirFigures) {
  const PatchMesh mesh = test::meshOf(test::dataScene(GetParam()), 300);
  const FormFactors truth = test::computed(mesh, test::exactly(1e-4));
  constexpr double kTolerance = 2e-2;
  const FormFactors f = test::computed(mesh, byRays(kTolerance));
  EXPECT_EQ(f.report.rays.short_rows, 0u);
  const Score found = score(f, truth);
  // The tolerance is the root mean square that is expected of a row: the matrix keeps it, and a
  // row of few entries may be off by some times as much.
  EXPECT_LT(found.all, kTolerance);
  EXPECT_LT(found.largest, 3 * kTolerance);
  // 99% are stated; of 300 to 400 rows two more may be above by chance (three standard deviations
  // of a binomial are 1.6%).
  EXPECT_GT(double(found.below_figure), 0.974 * double(found.rows));
  EXPECT_NEAR(f.report.error_figure, found.all, 0.25 * found.all);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RaysAgainstExact,
                         testing::Values("cornell-box-closed", "two-rooms", "blocked-plates"));

TEST(Rays, GiveTheSameBitsForAnyNumberOfThreads) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  setThreads(1);
  const FormFactors one = test::computed(mesh, byRays(3e-2));
  setThreads(0);
  const FormFactors all = test::computed(mesh, byRays(3e-2));
  EXPECT_EQ(one.report.rays.rays, all.report.rays.rays);
  EXPECT_EQ(one.error, all.error);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      ASSERT_EQ(one.matrix->at(i, j), all.matrix->at(i, j));
    }
  }
}

TEST(Rays, OtherSeedsGiveOtherRaysAndTheSameValues) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  FormFactorOptions options = byRays(2e-2);
  const FormFactors first = test::computed(mesh, options);
  options.seed = 2;
  const FormFactors second = test::computed(mesh, options);
  const Score found = score(first, second);
  EXPECT_GT(found.all, 0);
  EXPECT_LT(found.all, 2 * 2e-2);  // each is off by one tolerance at most
}

TEST(Rays, DoNotDependOnPlaceOrUnit) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  PatchMesh far = mesh;
  const Vec3 offset(1048576.0, -2097152.0, 524288.0);
  for (Vec3& v : far.vertices) v = 1024.0 * v + offset;
  for (Vec3& c : far.centroid) c = 1024.0 * c + offset;
  for (Vec3& o : far.polygons.origin) o = 1024.0 * o + offset;
  for (double& a : far.area) a *= 1024.0 * 1024.0;
  const FormFactors here = test::computed(mesh, byRays(2e-2));
  const FormFactors there = test::computed(far, byRays(2e-2));
  // Single precision rounds places of rays: next to no ray ends elsewhere.
  EXPECT_LT(score(there, here).all, 1e-3);
}

TEST(Rays, TellSkyAndBacksFromFronts) {
  // A floor below a smaller plate that turns its black back down, in the open.
  test::MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  builder.grid("plate", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 1, 1);
  const PatchMesh mesh = builder.build();
  const FormFactors f = test::computed(mesh, byRays(1e-2));
  EXPECT_FALSE(f.report.closed);
  double backs = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(f.fronts[i], 0);
    EXPECT_NEAR(f.backs[i] + f.sky[i], 1, 1e-12);
    backs += f.backs[i] / 4;
  }
  // Two unit squares one apart, as the faces of a cube; the floor's four rows have no entry, so
  // that their backs alone are adapted: to 1e-2 of each.
  EXPECT_NEAR(backs, 0.199824895698, 2e-3);
  EXPECT_EQ(f.sky[4], 1);
}

/// A ceiling low over tiles: four face it, and all others turn their backs to it. Its row has a
/// small norm and takes few rays, so that it knows its backs badly; the tiles' rows know well what
/// it sees of them, and so of backs.
TEST(Rays, ClosureBringsBacksNearerToTheirTrueShare) {
  test::MeshBuilder builder;
  builder.box("room", {-4, -4, -4}, {4, 4, 4}, 2, true);
  builder.grid("ceiling", {-1, -1, 0.012}, {0, 2, 0}, {2, 0, 0});
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 8; ++y) {
      const Vec3 at(0.25 * x - 1, 0.25 * y - 1, 0);
      const Vec3 u(0.25, 0, 0);
      const Vec3 v(0, 0.25, 0);
      const bool up = x % 4 == 1 && y % 4 == 1;
      builder.grid(up ? "tiles" : "panels", at, up ? u : v, up ? v : u);
    }
  }
  const PatchMesh mesh = builder.build();
  const std::size_t ceiling = 24;
  ASSERT_EQ(mesh.surface_names[mesh.surface[ceiling]], "ceiling");
  const double truth = test::computed(mesh, test::exactly(1e-4)).backs[ceiling];
  const auto squaredError = [&](ClosureMode mode, std::uint64_t seed) {
    FormFactorOptions options = byRays(1e-2);
    options.seed = seed;
    options.closure = mode;
    const FormFactors f = test::computed(mesh, options);
    double backs = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) backs += mesh.area[i] * f.backs[i];
    backs /= std::reduce(mesh.area.begin(), mesh.area.end());
    const std::vector<double>& by_surface = f.backs_by_surface;
    EXPECT_NEAR(std::reduce(by_surface.begin(), by_surface.end()), backs, 1e-9);
    return std::pow(f.backs[ceiling] - truth, 2);
  };
  double closed = 0;
  double own = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    closed += squaredError(ClosureMode::enforce, seed);
    own += squaredError(ClosureMode::off, seed);
  }
  EXPECT_LT(closed, 0.5 * own);
}

/// The gap is wider than rays start before their plane: from outside there are backs alone, as from
/// inside there are fronts alone.
TEST(Rays, PlatesCloseToEachOtherAreSeenAlikeFromBothEnds) {
  constexpr double kGap = 1e-6;
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 1, true);
  builder.grid("low", {0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0});
  builder.grid("high", {0.25, 0.25, 0.5 + kGap}, {0, 0.5, 0}, {0.5, 0, 0});
  const PatchMesh mesh = builder.build();
  FormFactorOptions options = byRays(1e-2);
  options.closure = ClosureMode::off;
  const FormFactors f = test::computed(mesh, options);
  EXPECT_NEAR(f.matrix->at(6, 7), 1, 1e-4);
  for (std::size_t wall = 0; wall < 6; ++wall) {
    EXPECT_EQ(f.matrix->at(wall, 6), 0);
    EXPECT_EQ(f.matrix->at(wall, 7), 0);
    EXPECT_GT(f.backs[wall], 0.01);
  }
}

/// Nearly every ray of one plate ends on the other, down to gaps that single precision cannot tell.
/// No ray is lost, and a row that saw one thing alone is not called exact.
TEST(Rays, PlatesAHairApartSeeEachOtherWhole) {
  for (const double gap : {2e-7, 6e-7, 2e-6, 1e-5}) {
    for (const double angle : {0.0, 0.3, 1.1, 2.5}) {
      SCOPED_TRACE(std::to_string(1e9 * gap) + " nm, " + std::to_string(angle));
      const Vec3 axis = glm::normalize(Vec3(1, 2, -0.5));
      const auto turned = [&](const Vec3& p) { return test::rotated(p, axis, angle); };
      test::MeshBuilder builder;
      builder.grid("low", turned({0.2, -0.7, 0.4}), turned({1, 0, 0}), turned({0, 1, 0}));
      builder.grid("high", turned({0.2, -0.7, 0.4 + gap}), turned({0, 1, 0}), turned({1, 0, 0}));
      const FormFactors f = test::computed(builder.build(), byRays(1e-2));
      for (std::size_t i = 0; i < 2; ++i) {
        // Howell C-11 for a small gap: 1 less half of it along each edge.
        const double error = std::abs(f.matrix->at(i, 1 - i) - (1 - 2 * gap));
        EXPECT_GT(f.error[i], 0);
        EXPECT_LE(error, f.error[i] + 1e-7);  // values are floats
        EXPECT_NEAR(f.fronts[i] + f.backs[i] + f.sky[i], 1, 1e-6);
      }
    }
  }
}

/// A lamp under a ceiling, nearer than single precision tells at its distance: it hides what is
/// above it, from everywhere.
TEST(Rays, ALampAHairUnderItsCeilingHidesIt) {
  for (const double gap : {4e-7, 1e-6, 3e-6}) {
    for (const double angle : {0.0, 0.7, 2.0}) {
      SCOPED_TRACE(std::to_string(1e9 * gap) + " nm, " + std::to_string(angle));
      test::SceneBuilder builder;
      builder.box(builder.surface("room"), {0, 0, 0}, {1, 1, 1}, false);
      builder.level(builder.surface("lamp"), 0.2, 0.3, 0.7, 0.8, 1 - gap, false);
      Scene scene = builder.scene();
      for (Vec3& p : scene.vertices) p = test::rotated(p, glm::normalize(Vec3(1, -1, 2)), angle);
      const PatchMesh mesh = test::meshOf(scene, 40);
      const FormFactors f = test::computed(mesh, byRays(1e-2));
      const FormFactors truth = test::computed(mesh, test::exactly(1e-4));
      const Score of = score(f, truth);
      EXPECT_LE(of.all, 2e-2);
      EXPECT_GE(of.below_figure + 2, of.rows);  // 99%, and one more by chance
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        EXPECT_NEAR(f.fronts[i] + f.backs[i] + f.sky[i], 1, 1e-6) << i;
      }
    }
  }
}

TEST(Rays, GoOnUntilATighterToleranceIsMet) {
  const PatchMesh mesh = test::roomWithBlock(3).build();
  const FormFactors truth = test::computed(mesh, test::exactly(1e-5));
  double before = 1;
  for (const double tolerance : {5e-2, 1e-2, 3e-3}) {
    const Score found = score(test::computed(mesh, byRays(tolerance)), truth);
    EXPECT_LT(found.all, tolerance);
    EXPECT_LT(found.all, before);
    before = found.all;
  }
}

/// Rays that grow as the inverse square of the tolerance.
TEST(RayAim, LoosensToleranceJustEnoughForTheRaysAllowed) {
  const auto raysAt = [](double loosened) { return 1e6 / (loosened * loosened); };
  EXPECT_EQ(loosening(1e6, raysAt), 1);
  const double times = loosening(1e4, raysAt);
  EXPECT_LE(raysAt(times), 1e4);
  EXPECT_GE(raysAt(times / 1.01), 1e4);  // it is sought to a hundredth
}

TEST(RayAim, OnlyTheDefaultToleranceIsLoosened) {
  FormFactorOptions options;
  EXPECT_EQ(RayAim(options).most_rays, FormFactorOptions::kMostRaysUnasked);
  EXPECT_EQ(RayAim(options).tolerance, FormFactorOptions::kRayTolerance);
  options.tolerance = FormFactorOptions::kRayTolerance;
  EXPECT_EQ(RayAim(options).most_rays, std::numeric_limits<double>::infinity());
}

/// Two blocks under the sky see little of each other. The tolerance of 3% of a tenth of the sky
/// allows errors of .003 (L2) in a row, and the rms error of row sums stays within that here.
TEST(RayAim, SourcesUnderTheSkyTakeFewRays) {
  test::MeshBuilder builder;
  builder.box("low", Vec3(0), Vec3(1), 5);
  builder.box("high", {4, 0.2, 0}, {5, 1.2, 2}, 5);
  const PatchMesh mesh = builder.build();
  FormFactorOptions sources;
  sources.method = FormFactorMethod::rays;
  sources.sources_only = true;
  EXPECT_EQ(sources.skyWeight(), FormFactorOptions::kSourceSky);
  const FormFactors few = test::computed(mesh, sources);
  const FormFactors many = test::computed(mesh, byRays(FormFactorOptions::kSourceTolerance));
  EXPECT_LT(few.report.rays.rays, many.report.rays.rays / 4);
  EXPECT_LT(few.report.error_figure, FormFactorOptions::kSourceTolerance);
  FormFactorOptions options;
  options.method = FormFactorMethod::exact;
  const FormFactors exact = test::computed(mesh, options);
  double squares = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    squares += std::pow(few.fronts[i] - exact.fronts[i], 2) / double(mesh.size());
  }
  EXPECT_LT(std::sqrt(squares), 3e-3);
  sources.tolerance = FormFactorOptions::kSourceTolerance;
  EXPECT_EQ(sources.skyWeight(), 0) << "a tolerance that was asked for holds for F";
}

TEST(RayAim, RowsShareTheRaysAllowedAndTheReportNamesTheirTolerance) {
  const PatchMesh mesh = test::roomWithBlock(4).build();
  const RayScene scene(mesh, 1);
  RayAim aim(byRays(1e-3));
  aim.most_rays = 1e6;
  RayReport report;
  Progress silent;
  const std::vector<RayRow> rows = castRows(scene, {}, aim, report, {silent});
  EXPECT_GT(report.rays, 5e5);  // rows are cast to the next 2^k or 3 2^k, down to half
  EXPECT_LE(report.rays, 1e6);
  ASSERT_TRUE(report.loosened_tolerance);
  EXPECT_GT(*report.loosened_tolerance, 1e-3);
  EXPECT_LT(*report.loosened_tolerance, 1e-1);
  EXPECT_EQ(report.short_rows, mesh.size());
}

TEST(Rays, CanBeInterrupted) {
  const PatchMesh mesh = test::roomWithBlock(4).build();
  Progress cancelled;
  cancelled.cancel();
  EXPECT_THROW(computeFormFactors(mesh, byRays(1e-3), cancelled), Cancelled);
}

}  // namespace
}  // namespace radiosity
