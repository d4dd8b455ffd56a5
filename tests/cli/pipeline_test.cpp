// From scene file to solution on the scenes of data/: answers that are known in closed form or that
// must not depend on how the scene is cut, turned or placed.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "radiosity/solve.h"

namespace radiosity {
namespace {

const std::string kData = RADIOSITY_SOURCE_DIR "/data/";

struct Lit {
  MeshResult meshed;
  FormFactors factors;
  PatchMaterials materials;
  Solution solution;
};

Lit light(const Scene& scene, std::size_t patches, int resolution,
          Precision precision = Precision::single_precision, double tolerance = 1e-6) {
  Progress quiet;
  MeshOptions mesh_options;
  mesh_options.patches = patches;
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  options.precision = precision;
  SolveOptions solving;
  solving.tolerance = tolerance;
  Lit lit;
  lit.meshed = meshScene(scene, mesh_options, quiet);
  lit.factors = computeFormFactors(lit.meshed.mesh, options, quiet);
  lit.materials = patchMaterials(scene, lit.meshed.mesh);
  lit.solution = solve(lit.factors, lit.materials, lit.meshed.mesh, solving, quiet);
  return lit;
}

/// Area-weighted mean radiosity of each surface, by name.
std::map<std::string, Vec3> meanBySurface(const Lit& lit) {
  const PatchMesh& mesh = lit.meshed.mesh;
  std::map<std::string, Vec3> sum;
  std::map<std::string, double> area;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const std::string& name = mesh.surface_names[mesh.surface[i]];
    for (int b = 0; b < 3; ++b) {
      sum[name][b] += mesh.area[i] * lit.solution.radiosity[3 * i + b];
    }
    area[name] += mesh.area[i];
  }
  for (auto& [name, value] : sum) value /= area[name];
  return sum;
}

/// Area-to-area form factor from one surface to another out of the patches' rows.
double surfaceToSurface(const Lit& lit, const std::string& from, const std::string& to) {
  const PatchMesh& mesh = lit.meshed.mesh;
  double exchange = 0;
  double area = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.surface_names[mesh.surface[i]] != from) continue;
    area += mesh.area[i];
    pairsOf(*lit.factors.matrix).forRow(i, [&](Index j, double f) {
      if (mesh.surface_names[mesh.surface[j]] == to) exchange += mesh.area[i] * f;
    });
  }
  return exchange / area;
}

void makeUniform(Scene& scene, double reflectance, double emission) {
  for (Material& material : scene.materials) {
    material.reflectance = Vec3(reflectance);
    material.emission = Vec3(emission);
    material.texture = kNone;
  }
}

TEST(Pipeline, EveryClosedSceneIsAFurnace) {
  // B = E / (1 - rho) whatever the form factors, once rows sum to 1: exact up to rounding of the
  // solver, which stops at 1e-13 of E and is then within 1e-13 / (1 - rho) = 1e-12.
  for (const char* name : {"furnace-cube", "cornell-box-closed", "two-rooms", "curved"}) {
    Scene scene = loadScene(kData + name + ".obj");
    makeUniform(scene, 0.9, 1.0);
    const Lit lit = light(scene, 600, 64, Precision::double_precision, 1e-13);
    EXPECT_TRUE(lit.factors.report.closed) << name;
    EXPECT_EQ(lit.solution.summary.status, SolveStatus::converged) << name;
    double worst_row = 0;
    for (double sum : lit.factors.fronts) worst_row = std::max(worst_row, std::abs(sum - 1));
    EXPECT_LT(worst_row, 1e-12) << name;
    for (double b : lit.solution.radiosity) ASSERT_NEAR(b, 10.0, 1e-10) << name;
  }
}

TEST(Pipeline, TheFurnaceCubeHasItsClosedForm) {
  const Lit lit = light(loadScene(kData + "furnace-cube.obj"), 96, 128);
  // Single precision rows: each of up to 80 entries is off by 3e-8 of itself.
  for (double b : lit.solution.radiosity) ASSERT_NEAR(b, 2.0, 1e-6);
}

struct PlateCase {
  const char* scene;
  double truth;
  double lowest_order;
};

TEST(Pipeline, PlatesConvergeToTheAreaValue) {
  // The eye at a patch's centroid is the midpoint rule over the sending plate: second order in the
  // patch size where the integrand is smooth. The blocker's shadow edges are kinks that the
  // midpoint rule meets at order 1 or better; asserted orders leave room for the pixels' noise,
  // which 512 pixels keep below the finest difference.
  const PlateCase cases[] = {{"facing-plates", 0.199824895698387, 1.7},
                             {"touching-plates", 0.200043776075403, 1.4},
                             {"blocked-plates", 0.0995062945990, 0.9}};
  for (const PlateCase& c : cases) {
    const Scene scene = loadScene(kData + c.scene + ".obj");
    std::vector<double> errors;
    for (std::size_t n : {4, 16}) {  // patches along an edge, about
      const std::size_t plates = std::string(c.scene) == "blocked-plates" ? 3 : 2;
      const Lit lit = light(scene, plates * n * n, 512);
      errors.push_back(std::abs(surfaceToSurface(lit, "lower", "upper") / c.truth - 1));
    }
    const double order = std::log2(errors[0] / errors[1]) / 2;
    EXPECT_GT(order, c.lowest_order) << c.scene << ": " << errors[0] << " " << errors[1];
    EXPECT_LT(errors[1], 3e-3) << c.scene;
  }
}

TEST(Pipeline, BrightnessDoesNotDependOnTheMesh) {
  const Scene scene = loadScene(kData + "cornell-box.obj");
  const auto coarse = meanBySurface(light(scene, 600, 128));
  const auto fine = meanBySurface(light(scene, 2400, 128));
  ASSERT_EQ(coarse.size(), fine.size());
  for (const auto& [name, value] : fine) {
    // Discretisation: one eye a patch over- or undersees near neighbours; at 600 patches that moves
    // a surface's mean by up to about 2%, which halves at each refinement.
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(coarse.at(name)[b] / value[b], 1.0, 0.04) << name;
  }
}

TEST(Pipeline, ColourBleedsFromTheNearWall) {
  const Lit lit = light(loadScene(kData + "cornell-box.obj"), 1500, 128);
  const PatchMesh& mesh = lit.meshed.mesh;
  Vec3 near_red(0.0);
  Vec3 near_green(0.0);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.surface_names[mesh.surface[i]] != "floor/white") continue;
    const Vec3 b(lit.solution.radiosity[3 * i], lit.solution.radiosity[3 * i + 1],
                 lit.solution.radiosity[3 * i + 2]);
    if (mesh.centroid[i].x > 0.5) near_red += mesh.area[i] * b;
    if (mesh.centroid[i].x < 0.05) near_green += mesh.area[i] * b;
  }
  // Red paint reflects 12 times more in red than in green, green paint 3 times less.
  EXPECT_GT(near_red.x / near_red.y, 1.2 * near_green.x / near_green.y);
}

TEST(Pipeline, BlocksHaveNoUndersidesAndNothingLeaks) {
  const Lit lit = light(loadScene(kData + "cornell-box-closed.obj"), 1500, 64);
  const PatchMesh& mesh = lit.meshed.mesh;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const Vec3 c = mesh.centroid[i];
    EXPECT_GE(mesh.normal[i].y, c.y < 1e-9 ? 0.99 : -1.0) << "underside kept, patch " << i;
    EXPECT_EQ(lit.factors.backs[i], 0.0) << "patch " << i << " sees a back";
    EXPECT_EQ(lit.factors.sky[i], 0.0) << "patch " << i << " sees the sky";
  }
  for (const SurfaceAreas& areas : lit.meshed.report.surfaces) {
    // The contact area: the block's footprint, from its published corners by the shoelace rule.
    if (areas.name == "short_block/white") {
      EXPECT_NEAR(areas.buried, 0.027633, 1e-9);
    }
    EXPECT_NEAR(areas.given, areas.kept + areas.buried + areas.overlapped + areas.degenerate,
                1e-12 * areas.given);
  }
}

TEST(Pipeline, ADoorwayPassesLittleLight) {
  const auto mean = meanBySurface(light(loadScene(kData + "two-rooms.obj"), 1500, 128));
  EXPECT_GT(mean.at("dark_floor/wood").x, 0.0);
  EXPECT_LT(mean.at("dark_floor/wood").x, 0.2 * mean.at("lit_floor/wood").x);
}

TEST(Pipeline, EveryMeshConforms) {
  Progress quiet;
  for (const char* name :
       {"cornell-box", "cornell-box-closed", "furnace-cube", "facing-plates", "touching-plates",
        "blocked-plates", "two-rooms", "furnished-room", "curved", "cluttered"}) {
    const Scene scene = loadScene(kData + name + ".obj");
    for (std::size_t patches : {200, 3000}) {
      MeshOptions options;
      options.patches = patches;
      const MeshResult result = meshScene(scene, options, quiet);
      EXPECT_EQ(result.report.t_junctions, 0u) << name << " " << patches;
      for (const SurfaceAreas& areas : result.report.surfaces) {
        EXPECT_NEAR(areas.given, areas.kept + areas.buried + areas.overlapped + areas.degenerate,
                    1e-12 * areas.given)
            << name << " " << areas.name;
      }
    }
  }
}

// ---- Sameness under scale, place and turn
// ----------------------------------------------------------

Scene transformed(Scene scene, double scale, const Vec3& shift, bool turn) {
  const glm::dmat4 rotation =
      turn ? glm::rotate(glm::dmat4(1.0), std::numbers::sqrt2, glm::normalize(Vec3(1, 2, 3)))
           : glm::dmat4(1.0);
  for (Vec3& v : scene.vertices) v = scale * Vec3(rotation * glm::dvec4(v, 1.0)) + shift;
  return scene;
}

TEST(Pipeline, PowersOfTwoChangeNoBit) {
  const Scene scene = loadScene(kData + "cornell-box-closed.obj");
  const Lit plain = light(scene, 400, 64);
  for (double scale : {0x1p-20, 0x1p20}) {
    const Lit scaled = light(transformed(scene, scale, Vec3(0.0), false), 400, 64);
    ASSERT_EQ(scaled.meshed.mesh.size(), plain.meshed.mesh.size()) << scale;
    EXPECT_EQ(scaled.solution.radiosity, plain.solution.radiosity) << scale;
  }
}

TEST(Pipeline, PlaceScaleAndTurnKeepTheMeansOfSurfaces) {
  const Scene scene = loadScene(kData + "cornell-box-closed.obj");
  const auto plain = meanBySurface(light(scene, 800, 128));
  const struct {
    const char* what;
    Scene scene;
  } cases[] = {{"scale 1e-6", transformed(scene, 1e-6, Vec3(0.0), false)},
               {"scale 1e6", transformed(scene, 1e6, Vec3(0.0), false)},
               {"moved 1e6 diameters", transformed(scene, 1.0, Vec3(1e6, -1e6, 1e6), false)},
               {"turned", transformed(scene, 1.0, Vec3(0.0), true)}};
  for (const auto& c : cases) {
    for (const auto& [name, value] : meanBySurface(light(c.scene, 800, 128))) {
      // Another frame means other random turns of the hemicubes: pixel noise of a surface's mean,
      // which at 128 pixels stays below 1%.
      for (int b = 0; b < 3; ++b) {
        EXPECT_NEAR(value[b] / plain.at(name)[b], 1.0, 0.01) << c.what << " " << name;
      }
    }
  }
}

}  // namespace
}  // namespace radiosity
