// Clusters of patches: as many as asked for, each patch in one, of one surface.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <set>

#include "mesh/clusters/cluster_patches.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;
using test::turned;

MeshResult meshed(const Scene& scene, std::size_t patches) {
  Progress progress;
  MeshOptions options;
  options.patches = patches;
  return meshScene(scene, options, progress);
}

PatchClusters clustered(const PatchMesh& mesh, std::size_t wanted) {
  Progress progress;
  return clusterPatches(mesh, wanted, progress);
}

/// Both sides counted once.
std::size_t clustersOfFronts(const PatchMesh& mesh, const PatchClusters& clusters) {
  std::set<Index> found;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.side[i] == 0) found.insert(clusters.of_patch[i]);
  }
  return found.size();
}

/// Degrees: the largest angle between the normal of a patch and the mean of its cluster.
double widestCone(const PatchMesh& mesh, const PatchClusters& clusters) {
  double widest = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    Vec3 mean(0.0);
    for (const Index i : clusters.patchesOf(c)) mean += mesh.area[i] * mesh.normal[i];
    for (const Index i : clusters.patchesOf(c)) {
      const Vec3& n = mesh.normal[i];
      widest = std::max(widest, std::atan2(glm::length(glm::cross(mean, n)), glm::dot(mean, n)));
    }
  }
  return widest * 180 / std::numbers::pi;
}

void expectPartition(const PatchMesh& mesh, const PatchClusters& clusters) {
  ASSERT_EQ(clusters.of_patch.size(), mesh.size());
  ASSERT_EQ(clusters.patches.size(), mesh.size());
  double area = 0;
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const auto patches = clusters.patchesOf(c);
    ASSERT_FALSE(patches.empty());
    EXPECT_TRUE(std::is_sorted(patches.begin(), patches.end()));
    for (const Index i : patches) {
      EXPECT_EQ(clusters.of_patch[i], c);
      EXPECT_EQ(mesh.surface[i], mesh.surface[patches[0]]);
      EXPECT_EQ(mesh.side[i], mesh.side[patches[0]]);
      area += mesh.area[i];
    }
  }
  const double all = std::accumulate(mesh.area.begin(), mesh.area.end(), 0.0);
  EXPECT_NEAR(area, all, 1e-12 * all);  // the same numbers in another order
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (std::size_t j = i; j < mesh.size() && mesh.twin[i] != kNone; j += 97) {
      if (mesh.twin[j] == kNone) continue;
      EXPECT_EQ(clusters.of_patch[i] == clusters.of_patch[j],
                clusters.of_patch[mesh.twin[i]] == clusters.of_patch[mesh.twin[j]]);
    }
  }
}

Scene ball() {
  SceneBuilder builder;
  const Index s = builder.surface("ball");
  constexpr int kRings = 30;
  constexpr int kAround = 60;
  const auto point = [](int ring, int k) {
    const double a = std::numbers::pi * ring / kRings;
    const double b = 2 * std::numbers::pi * (k % kAround) / kAround;
    return Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < kAround; ++k) {
      std::vector<Vec3> face{point(ring + 1, k), point(ring + 1, k + 1)};
      if (ring > 0) face.push_back(point(ring, k + 1));
      face.push_back(point(ring, k));
      if (ring + 1 == kRings) face.erase(face.begin());
      builder.face(s, face);
    }
  }
  return builder.scene();
}

Scene terrain(bool two_sided) {
  SceneBuilder builder;
  const Index s = builder.surface("ground", 0.5, 0, two_sided);
  constexpr int kSteps = 36;
  const auto point = [](int i, int j) {
    return Vec3(i, j, 3 * std::sin(0.3 * i) * std::cos(0.2 * j) + 0.4 * std::sin(1.3 * i + j));
  };
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      builder.face(s, {point(i, j), point(i + 1, j), point(i + 1, j + 1)});
      builder.face(s, {point(i, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  return builder.scene();
}

/// Boxes that do not touch, of one surface, over a floor of another.
Scene boxes() {
  SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 20, 20, 0);
  const Index s = builder.surface("boxes");
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const Vec3 low(i + 0.1, j + 0.2, 0.5 + 0.1 * ((i * 7 + j * 3) % 5));
      builder.box(s, low, low + Vec3(0.3, 0.2, 0.4));
    }
  }
  return builder.scene();
}

/// A fan of slender triangles around a point, in steps.
Scene slivers() {
  SceneBuilder builder;
  const Index s = builder.surface("fan");
  constexpr int kAround = 1500;
  for (int k = 0; k < kAround; ++k) {
    const auto rim = [&](int at) {
      const double a = 2 * std::numbers::pi * at / kAround;
      return Vec3(10 * std::cos(a), 10 * std::sin(a), at % 2 == 0 ? 0.5 : 0.0);
    };
    builder.face(s, {{0, 0, 1}, rim(k), rim((k + 1) % kAround)});
  }
  return builder.scene();
}

/// Two-sided cards that touch nothing, turned all ways.
Scene cards() {
  SceneBuilder builder;
  const Index s = builder.surface("leaf", 0.5, 0, true);
  for (int k = 0; k < 700; ++k) {
    const Vec3 at(k % 10, k / 10 % 10, k / 100);
    const Vec3 u(0.3 * std::cos(k), 0.3 * std::sin(k), 0);
    const Vec3 v(0.1 * std::sin(3.0 * k) * std::sin(k), -0.1 * std::sin(3.0 * k) * std::cos(k),
                 0.2 * std::cos(3.0 * k));
    builder.face(s, {at, at + u, at + u + v, at + v});
  }
  return builder.scene();
}

/// Many two-sided pages at one spine.
Scene pages() {
  SceneBuilder builder;
  const Index s = builder.surface("pages", 0.5, 0, true);
  for (int k = 0; k < 300; ++k) {
    const double a = std::numbers::pi * k / 300;
    const Vec3 out(std::cos(a), std::sin(a), 0);
    builder.face(s, {{0, 0, 0}, out, out + Vec3(0, 0, 2), {0, 0, 2}});
  }
  return builder.scene();
}

struct Named {
  const char* name;
  Scene (*scene)();
  std::size_t patches;
};

class Clusters : public testing::TestWithParam<Named> {};

TEST_P(Clusters, AreAsManyAsRequested) {
  const auto& [name, scene, patches] = GetParam();
  for (const Scene& s : {scene(), turned(scene())}) {
    const PatchMesh mesh = meshed(s, patches).mesh;
    ASSERT_GT(double(mesh.frontCount()), 1.2 * double(patches)) << "the scene has to have more";
    const PatchClusters clusters = clustered(mesh, patches);
    expectPartition(mesh, clusters);
    EXPECT_EQ(clustersOfFronts(mesh, clusters), patches);
    // A second run gives the same.
    EXPECT_EQ(clustered(meshed(s, patches).mesh, patches).of_patch, clusters.of_patch);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, Clusters,
    testing::Values(Named{"ball", ball, 200}, Named{"coarse ball", ball, 7},
                    Named{"terrain", [] { return terrain(false); }, 400},
                    Named{"two-sided terrain", [] { return terrain(true); }, 300},
                    Named{"boxes", boxes, 500}, Named{"few for boxes", boxes, 60},
                    Named{"slivers", slivers, 100}, Named{"cards", cards, 150},
                    Named{"pages", pages, 50}),
    [](const auto& scene) {
      std::string name = scene.param.name;
      std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
      return name;
    });

TEST(ClustersOfAMesh, NumberAtLeastOneASurface) {
  SceneBuilder builder;
  for (int k = 0; k < 40; ++k) {
    const Vec3 low(k, 0, 0);
    builder.box(builder.surface("box " + std::to_string(k)), low, low + Vec3(0.5));
  }
  const PatchMesh mesh = meshed(builder.scene(), 10).mesh;
  const PatchClusters clusters = clustered(mesh, 10);
  expectPartition(mesh, clusters);
  EXPECT_EQ(clusters.size(), 40u);
}

TEST(ClustersOfAMesh, DoNotDependOnTheOrderOfSurfaces) {
  // Two equal balls, and the same the other way round: ties between them go by name.
  const auto balls = [](bool swapped) {
    Scene scene = ball();
    const std::size_t faces = scene.faceCount();
    const Scene one = scene;
    scene.surfaces.push_back({"other", 0, "other/ball"});
    const Index offset = Index(one.vertices.size());
    for (const Vec3& p : one.vertices) scene.vertices.push_back(p + Vec3(3, 0, 0));
    for (std::size_t f = 0; f < faces; ++f) {
      for (const Index v : one.face(Index(f))) scene.corners.push_back(v + offset);
      scene.face_offset.push_back(scene.corners.size());
      scene.face_surface.push_back(1);
      scene.face_element.push_back(f);
    }
    if (swapped) {
      std::swap(scene.surfaces[0], scene.surfaces[1]);
      for (Index& s : scene.face_surface) s = 1 - s;
    }
    return scene;
  };
  const auto clustersByName = [](const PatchMesh& mesh) {
    std::map<std::string, std::set<std::vector<Index>>> found;
    const PatchClusters clusters = clustered(mesh, 101);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      std::vector<Index> inside;
      for (const Index i : clusters.patchesOf(c)) inside.push_back(mesh.index_in_surface[i]);
      std::sort(inside.begin(), inside.end());
      found[mesh.surface_names[mesh.surface[clusters.patchesOf(c)[0]]]].insert(inside);
    }
    return found;
  };
  EXPECT_EQ(clustersByName(meshed(balls(false), 101).mesh),
            clustersByName(meshed(balls(true), 101).mesh));
}

TEST(ClustersOfAMesh, AreSmallOnBentSurfaces) {
  // A cap of a 200th of a ball reaches 8 degrees. Clusters are neither equal nor round: four times
  // as far still shows that none is a strip around the ball.
  const PatchMesh mesh = meshed(ball(), 200).mesh;
  const double widest = widestCone(mesh, clustered(mesh, 200));
  EXPECT_LT(widest, 32);
  EXPECT_GT(widest, 4);
}

TEST(ClustersOfAMesh, ArePatchesIfThereAreNoMore) {
  SceneBuilder builder;
  builder.box(builder.surface("room"), Vec3(0), Vec3(1), false);
  const PatchMesh mesh = meshed(builder.scene(), 300).mesh;
  EXPECT_EQ(clustered(mesh, mesh.size()).size(), mesh.size());
  EXPECT_EQ(clustered(mesh, 10 * mesh.size()).size(), mesh.size());
}

TEST(ClustersOfAMesh, CanBeInterrupted) {
  const PatchMesh mesh = meshed(ball(), 5000).mesh;
  Progress progress;
  progress.cancel();
  EXPECT_THROW(clusterPatches(mesh, 100, progress), Cancelled);
}

}  // namespace
}  // namespace radiosity
