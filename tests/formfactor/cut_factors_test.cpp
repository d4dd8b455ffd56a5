// Rows that are cut through a tree: against exact form factors and closed forms, and by what they
// state of themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "formfactor/computed_factors.h"
#include "formfactor/exact_scenes.h"
#include "matrix/cut_operator.h"
#include "radiosity/form_factors.h"
#include "radiosity/solve.h"
#include "support/mesh_builder.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

FormFactorOptions byCuts(double tolerance) {
  FormFactorOptions options;
  options.method = FormFactorMethod::cut;
  options.tolerance = tolerance;
  return options;
}

/// Light that falls on some patches and not on others: the fields of a test know nothing of the
/// lights that rows were tried under.
std::vector<double> patchyLight(const PatchMesh& mesh) {
  std::vector<double> light;
  light.reserve(mesh.size());
  for (const Vec3& at : mesh.centroid) {
    light.push_back(std::sin(3 * at.x) * std::cos(2 * at.y + at.z) > 0.2 ? 1.0 + at.y * at.y : 0.1);
  }
  return light;
}

/// The relative error (L2, by area) of F x.
double irradianceError(const FormFactors& f, const FormFactors& truth,
                       const std::vector<double>& x) {
  std::vector<double> found(x.size());
  std::vector<double> right(x.size());
  f.matrix->product(x, 1, found);
  truth.matrix->product(x, 1, right);
  double squares = 0;
  double norm = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double area = f.matrix->area()[i];
    squares += area * (found[i] - right[i]) * (found[i] - right[i]);
    norm += area * right[i] * right[i];
  }
  return std::sqrt(squares / norm);
}

TEST(Cut, GivesTheIrradianceOfExactFormFactors) {
  const PatchMesh mesh = test::meshOf(test::dataScene("cluttered"), 1000);
  const FormFactors truth = test::computed(mesh, test::exactly(1e-2));
  const std::vector<double> light = patchyLight(mesh);
  for (const double tolerance : {0.05, 0.02}) {
    const FormFactors f = test::computed(mesh, byCuts(tolerance));
    const double error = irradianceError(f, truth, light);
    const double stated = f.matrix->relativeError(light, 1).value();
    // What rays and cuts of a thousand rows add up to is known to a fifth or so.
    EXPECT_LT(error, 1.3 * stated) << tolerance;
    EXPECT_GT(error, 0.3 * stated) << tolerance;
    // The light is another than those that rows were tried under.
    EXPECT_LT(stated, 2 * tolerance);
    EXPECT_LE(f.report.cut.error(), tolerance);
  }
}

/// A room that is lit through a door gets all of its light from the same few nodes: what their fits
/// are off by, all of its patches are off by, 6% where only the light of all patches counts.
TEST(Cut, LightsADimRoomRight) {
  const Scene scene = test::dataScene("two-rooms");
  const PatchMesh mesh = test::meshOf(scene, 3000);
  const PatchMaterials materials = patchMaterials(scene, mesh);
  const FormFactors truth = test::computed(mesh, test::exactly(1e-2));
  FormFactorOptions options = byCuts(0.03);
  options.exact_rows = emittingPatches(mesh, materials);
  const FormFactors f = test::computed(mesh, options);
  Progress quiet;
  const auto lightOf = [&](const FormFactors& factors) {
    const Solution solution = solve(factors, materials, mesh, {}, quiet);
    double power = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (!mesh.surface_names[mesh.surface[i]].starts_with("dark")) continue;
      power += mesh.area[i] * solution.irradiance[3 * i];
    }
    return power;
  };
  // It gets .07 of the mean light, and what rows are off by is held against a tenth of that at
  // least: .03 of it is .04 of theirs.
  EXPECT_NEAR(lightOf(f) / lightOf(truth), 1, 0.04);
}

TEST(Cut, ClosesItsRows) {
  const PatchMesh mesh = test::roomWithBlock(6).build();
  const FormFactors f = test::computed(mesh, byCuts(0.05));
  EXPECT_TRUE(f.report.closed);
  const std::vector<double> sums = f.matrix->rowSums();
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_NEAR(sums[i], f.fronts[i], 1e-9) << i;
    EXPECT_NEAR(f.fronts[i] + f.backs[i], 1, 1e-12) << i;
    EXPECT_EQ(f.sky[i], 0);
  }
}

TEST(Cut, FindsTheFormFactorsOfACube) {
  // Howell, "A Catalog of Radiation Configuration Factors", C-11 and C-14.
  constexpr double kOpposite = 0.199824895698;
  constexpr double kAdjoining = 0.200043776075;
  test::MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {1, 1, 1}, 1, true);
  const PatchMesh mesh = builder.build();
  const FormFactors f = test::computed(mesh, byCuts(1e-3));
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      if (i == j) continue;
      const bool opposite = glm::dot(mesh.normal[i], mesh.normal[j]) < -0.5;
      // To within the tolerance of the whole row, .45 in the norm, thrice.
      EXPECT_NEAR(f.matrix->at(i, j), opposite ? kOpposite : kAdjoining, 3e-3 * 0.45);
    }
  }
}

TEST(Cut, DoesNotDependOnPlaceAndSize) {
  const Scene scene = test::dataScene("cluttered");
  std::vector<double> first;
  for (const double scale : {1.0, 1024.0, 1.0 / 4096}) {
    Scene scaled = scene;
    for (Vec3& vertex : scaled.vertices) vertex = vertex * scale + Vec3(scale);
    const PatchMesh mesh = test::meshOf(scaled, 500);
    const FormFactors f = test::computed(mesh, byCuts(0.05));
    const std::vector<double> sums = f.matrix->rowSums();
    if (first.empty()) first = sums;
    ASSERT_EQ(sums.size(), first.size());
    double apart = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      apart = std::max(apart, std::abs(sums[i] - first[i]));
    }
    // Single rays end elsewhere where coordinates round otherwise.
    EXPECT_LT(apart, 0.02) << scale;
  }
}

/// A pitted plain of triangles, 1 apart.
PatchMesh pittedPlain(int side) {
  test::SceneBuilder builder;
  const Index plain = builder.surface("plain");
  const auto at = [](int i, int j) {
    const double x = 0.9 * i;
    const double y = 0.9 * j;
    const double deep = std::sin(x) * std::cos(1.3 * y + 0.3 * x);
    return Vec3(i, j, -2 * std::max(0.0, deep) + 0.3 * std::sin(7.0 * i + 11.0 * j));
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      builder.face(plain, {at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      builder.face(plain, {at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return test::meshOf(builder.scene(), 1, true);
}

// Where few patches see each other, what each of them sees of the other cannot be balanced: their
// rays differ. Scaled ever more, some got twice what could fall on them.
TEST(Cut, GivesNoPatchMoreThanShines) {
  const PatchMesh mesh = pittedPlain(45);
  const FormFactors f = test::computed(mesh, byCuts(0.02));
  std::vector<double> light;
  light.reserve(mesh.size());
  const Vec3 sun = glm::normalize(Vec3(1, 0.4, 0.2));
  for (const Vec3& normal : mesh.normal) light.push_back(std::max(0.0, glm::dot(sun, normal)));
  const double most = std::ranges::max(light);
  std::vector<double> irradiance(light.size());
  f.matrix->product(light, 1, irradiance);
  double worst = 0;
  for (Index i = 0; i < mesh.size(); ++i) {
    if (f.fronts[i] > 0.01) worst = std::max(worst, irradiance[i] / (most * f.fronts[i]));
  }
  // Fits over nodes may exceed what is in them, by less than a third here.
  EXPECT_LT(worst, 1.33);
}

// Floor under a sheet sees next to nothing but the sheet's back, and yet lies in nodes with the
// open floor: it must not take its part of the light that ends there.
TEST(Cut, BalancesPatchesThatOthersHide) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 4, 4, 0);
  builder.level(builder.surface("sheet"), 0.55, 0.55, 2.45, 3.45, 0.02);
  const Index wall = builder.surface("wall");
  builder.face(wall, {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  builder.face(wall, {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  const PatchMesh mesh = test::meshOf(builder.scene(), 6000);
  const FormFactors f = test::computed(mesh, byCuts(0.1));
  EXPECT_GT(f.report.cut.unbalanced_before, 0.05);
  // It is .002; .06 where each patch counts for half or more.
  EXPECT_LT(f.report.cut.unbalanced, 0.01);
}

TEST(Cut, HasTheSameBitsForAnyThreads) {
  const PatchMesh mesh = test::meshOf(test::dataScene("cornell-box-closed"), 400);
  setThreads(1);
  const FormFactors one = test::computed(mesh, byCuts(0.05));
  setThreads(0);
  const FormFactors all = test::computed(mesh, byCuts(0.05));
  EXPECT_EQ(one.matrix->dense(), all.matrix->dense());
  EXPECT_EQ(one.report.cut.error(), all.report.cut.error());
}

TEST(Cut, TakesExactRowsOfEmitters) {
  const Scene scene = test::dataScene("cornell-box-closed");
  const PatchMesh mesh = test::meshOf(scene, 400);
  const FormFactors truth = test::computed(mesh, test::exactly(1e-3));
  FormFactorOptions options = byCuts(0.05);
  options.exact_rows = emittingPatches(mesh, patchMaterials(scene, mesh));
  ASSERT_FALSE(options.exact_rows.empty());
  std::vector<double> lamp(mesh.size(), 0.0);
  for (const Index i : options.exact_rows) lamp[i] = 1;
  const FormFactors f = test::computed(mesh, options);
  EXPECT_EQ(f.report.exact_rows, options.exact_rows.size());
  // Both are exact to 1e-3 of a mean form factor.
  EXPECT_LT(irradianceError(f, truth, lamp), 2e-3);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    EXPECT_NEAR(f.fronts[i] + f.backs[i] + f.sky[i], 1, 1e-9);
  }
}

TEST(Cut, OfASceneWhereNothingSeesAnything) {
  test::MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8, 8);
  const PatchMesh mesh = builder.build();
  const FormFactors f = test::computed(mesh, byCuts(0.02));
  EXPECT_TRUE(f.seeNothing());
  for (std::size_t i = 0; i < mesh.size(); ++i) EXPECT_EQ(f.sky[i], 1);
  EXPECT_FALSE(f.matrix->relativeError(std::vector<double>(mesh.size(), 1.0), 1));
  const bool said = std::ranges::any_of(f.report.notes, [](const Note& note) {
    return note.text.find("error of irradiance is not known") != std::string::npos;
  });
  EXPECT_TRUE(said);
}

TEST(Cut, OfASinglePatch) {
  test::MeshBuilder builder;
  builder.grid("plate", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const FormFactors f = test::computed(builder.build(), byCuts(0.02));
  EXPECT_EQ(f.matrix->row(0), std::vector<double>{0.0});
  EXPECT_EQ(f.sky[0], 1);
}

}  // namespace
}  // namespace radiosity
