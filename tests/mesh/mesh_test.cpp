// meshScene() on the scenes of data/: invariants of every mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>
#include <string>

#include "radiosity/patch_mesh.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

std::string dataFile(const std::string& name) { return RADIOSITY_SOURCE_DIR "/data/" + name; }

MeshResult mesh(const Scene& scene, const MeshOptions& options = {}) {
  Progress progress;
  return meshScene(scene, options, progress);
}

/// Every patch facing as its polygon does, every index in range, identities unique; triangles and
/// convex quadrilaterals, unless cells were joined for want of patches.
void expectSound(const PatchMesh& m) {
  bool joined = false;
  for (std::size_t i = 0; i < m.size(); ++i) joined |= m.outline(i).size() > 4;
  std::vector<std::pair<Index, Index>> identities;
  for (std::size_t i = 0; i < m.size(); ++i) {
    ASSERT_LT(m.polygon[i], m.polygons.size());
    ASSERT_EQ(m.surface[i], m.polygons.surface[m.polygon[i]]);
    const Vec3& front = m.polygons.normal[m.polygon[i]];
    EXPECT_EQ(m.normal[i], m.side[i] == 0 ? front : -front);
    const auto outline = m.outline(i);
    const std::size_t n = outline.size();
    ASSERT_GE(n, 3u);
    for (std::size_t k = 0; k < n && !joined; ++k) {
      const Vec3& a = m.vertices[outline[k]];
      const Vec3& b = m.vertices[outline[(k + 1) % n]];
      const Vec3& c = m.vertices[outline[(k + 2) % n]];
      EXPECT_GT(glm::dot(glm::cross(b - a, c - b), m.normal[i]), 0) << "patch " << i;
    }
    identities.emplace_back(m.surface[i], m.index_in_surface[i]);
  }
  std::sort(identities.begin(), identities.end());
  EXPECT_EQ(std::unique(identities.begin(), identities.end()), identities.end());
}

void expectAreasAddUp(const MeshReport& report) {
  for (const SurfaceAreas& s : report.surfaces) {
    EXPECT_NEAR(s.kept + s.buried + s.overlapped + s.degenerate, s.given, 1e-12 * s.given)
        << s.name;
  }
}

class MeshOfData : public testing::TestWithParam<const char*> {};

TEST_P(MeshOfData, IsConformingAndLosesNoArea) {
  const Scene scene = loadScene(dataFile(GetParam()));
  for (const std::size_t patches : {500u, 5000u}) {
    MeshOptions options;
    options.patches = patches;
    const auto [m, report] = mesh(scene, options);
    expectSound(m);
    expectAreasAddUp(report);
    EXPECT_EQ(report.t_junctions, 0u);
    EXPECT_LE(report.triangles + report.quads, m.size());
    EXPECT_GT(double(m.frontCount()), 0.85 * double(patches));
    if (double(report.polygons) < double(patches)) {
      EXPECT_LE(double(m.frontCount()), 1.2 * double(patches));
    }
  }
}

TEST_P(MeshOfData, MaxEdgeHolds) {
  const Scene scene = loadScene(dataFile(GetParam()));
  MeshOptions options;
  options.max_edge = mesh(scene).report.longest_edge * 0.7;
  const auto [m, report] = mesh(scene, options);
  expectSound(m);
  EXPECT_EQ(report.t_junctions, 0u);
  // A length that divides evenly is met but for its rounding.
  EXPECT_LE(report.longest_edge, options.max_edge * (1 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Scenes, MeshOfData,
                         testing::Values("cornell-box.obj", "cornell-box-closed.obj",
                                         "two-rooms.obj", "curved.obj", "cluttered.obj",
                                         "furnished-room.obj", "blender-room.glb"));

TEST(MeshScene, CornellBoxHasNoSmallAngle) {
  for (const char* name : {"cornell-box.obj", "cornell-box-closed.obj"}) {
    const Scene scene = loadScene(dataFile(name));
    for (const std::size_t patches : {300u, 1000u, 2000u, 10000u}) {
      MeshOptions options;
      options.patches = patches;
      const auto [m, report] = mesh(scene, options);
      EXPECT_GE(report.smallest_angle, 20.0)
          << name << " " << patches << " on " << report.smallest_angle_surface;
      EXPECT_NEAR(double(m.size()), double(patches), 0.15 * double(patches)) << name;
      // The count can be had without joining cells.
      EXPECT_EQ(report.triangles + report.quads, m.size());
    }
  }
}

TEST(MeshScene, TurningMovingAndScalingKeepTheFigures) {
  const Scene scene = loadScene(dataFile("cornell-box.obj"));
  const auto plain = mesh(scene);
  for (const Scene& moved :
       {test::turned(scene), test::moved(scene, Vec3(1e6, -1e6, 1e6)), test::scaled(scene, 1e-6)}) {
    const auto [m, report] = mesh(moved);
    expectSound(m);
    expectAreasAddUp(report);
    EXPECT_EQ(report.t_junctions, 0u);
    EXPECT_EQ(report.polygons, plain.report.polygons);
    // Triangulation ties may fall otherwise; the sizes may not.
    EXPECT_NEAR(double(m.size()), double(plain.mesh.size()), 0.02 * double(plain.mesh.size()));
    EXPECT_GE(report.smallest_angle, 20.0);
  }
}

TEST(MeshScene, FacesAsPatchesKeepTheFacesOfTheFile) {
  const Scene scene = loadScene(dataFile("cornell-box.obj"));
  MeshOptions options;
  options.faces_as_patches = true;
  const auto [m, report] = mesh(scene, options);
  EXPECT_EQ(m.frontCount(), scene.faceCount());
}

TEST(MeshScene, OptionsAreChecked) {
  MeshOptions options;
  options.patches = 0;
  EXPECT_THROW(mesh(loadScene(dataFile("furnace-cube.obj")), options), InputError);
}

}  // namespace
}  // namespace radiosity
