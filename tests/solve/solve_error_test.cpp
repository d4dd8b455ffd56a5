// The error of irradiance that a solution states, against form factors a hundred times as exact.
#include <gtest/gtest.h>

#include <cmath>

#include "support/lit_scene.h"

namespace radiosity {
namespace {

struct Solved {
  std::optional<double> stated;
  std::vector<double> irradiance;
};

Solved solved(const PatchMesh& mesh, const PatchMaterials& materials, FormFactorMethod method,
              double tolerance, std::uint32_t seed = 1) {
  FormFactorOptions how;
  how.method = method;
  how.tolerance = tolerance;
  how.seed = seed;
  how.exact_rows = emittingPatches(mesh, materials);
  Progress quiet;
  const Solution solution = solve(computeFormFactors(mesh, how, quiet), materials, mesh, {}, quiet);
  return {solution.summary.irradiance_error, solution.irradiance};
}

/// Relative, L2 by area, over all bands.
double apart(const PatchMesh& mesh, const std::vector<double>& a, const std::vector<double>& b) {
  double off = 0;
  double all = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double area = mesh.area[k / (a.size() / mesh.size())];
    off += area * (a[k] - b[k]) * (a[k] - b[k]);
    all += area * b[k] * b[k];
  }
  return std::sqrt(off / all);
}

// Figures of rows hold in 99% of them, which is some 1.5 times what they are off by: five seeds are
// within. Another factor of 2 is left for what solving and closure make of it.
TEST(SolveError, IrradianceByRaysIsOffByAboutWhatIsStated) {
  for (const char* name : {"two-rooms.obj", "cornell-box.obj"}) {
    const Scene scene = test::dataScene(name);
    Progress quiet;
    const PatchMesh mesh = meshScene(scene, {.patches = 300}, quiet).mesh;
    const PatchMaterials materials = patchMaterials(scene, mesh);
    const Solved truth = solved(mesh, materials, FormFactorMethod::exact, 1e-4);
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
      const Solved found = solved(mesh, materials, FormFactorMethod::rays, 0.05, seed);
      ASSERT_TRUE(found.stated);
      const double off = apart(mesh, found.irradiance, truth.irradiance);
      EXPECT_LT(off, *found.stated) << name << " " << seed;
      EXPECT_GT(off, *found.stated / 3) << name << " " << seed;
    }
  }
}

// What rows miss of dark walls they find of a bright sky: under one, dark walls make rows that are
// off worth more than bright ones. Cut rows state what they are off by, not what they are within.
TEST(SolveError, IrradianceUnderASkyIsOffByAboutWhatIsStated) {
  for (const double reflectance : {0.1, 0.5, 0.9}) {
    Scene scene = test::dataScene("city.stl");
    for (Material& material : scene.materials) material.reflectance = Vec3(reflectance);
    scene.lights = {uniformSky({1, 1, 1})};
    Progress quiet;
    const PatchMesh mesh = meshScene(scene, {.patches = 600}, quiet).mesh;
    const PatchMaterials materials = patchMaterials(scene, mesh);
    const Solved truth = solved(mesh, materials, FormFactorMethod::exact, 1e-4);
    for (const FormFactorMethod method : {FormFactorMethod::rays, FormFactorMethod::cut}) {
      const Solved found = solved(mesh, materials, method, 0.05);
      ASSERT_TRUE(found.stated);
      const double off = apart(mesh, found.irradiance, truth.irradiance);
      const double margin = method == FormFactorMethod::cut ? 1.3 : 1.0;
      EXPECT_LT(off, margin * *found.stated) << reflectance;
      EXPECT_GT(off, *found.stated / 4) << reflectance;
    }
  }
}

// The figures of exact rows are bounds, 4 to 14 times what they are off by.
TEST(SolveError, IrradianceByExactRowsIsOffByLess) {
  const Scene scene = test::dataScene("two-rooms.obj");
  Progress quiet;
  const PatchMesh mesh = meshScene(scene, {.patches = 300}, quiet).mesh;
  const PatchMaterials materials = patchMaterials(scene, mesh);
  const Solved truth = solved(mesh, materials, FormFactorMethod::exact, 1e-4);
  const Solved found = solved(mesh, materials, FormFactorMethod::exact, 1e-2);
  ASSERT_TRUE(found.stated);
  EXPECT_LT(apart(mesh, found.irradiance, truth.irradiance), *found.stated);
  EXPECT_LT(*found.stated, 0.01);
  const Solved unknown = solved(mesh, materials, FormFactorMethod::hemicube, 0.1);
  EXPECT_FALSE(unknown.stated);
}

}  // namespace
}  // namespace radiosity
