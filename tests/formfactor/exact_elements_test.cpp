// The elements of the exact method: their tiling, their order, their dependences.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "support/mesh_builder.h"
#include "visibility/elements/convex_pieces.h"
#include "visibility/elements/elements.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

double totalArea(const ElementSet& set, const Facet& facet) {
  double sum = 0;
  for (Index e = facet.elements.first; e < facet.elements.end; ++e) sum += set.area[e];
  return sum / (set.scale * set.scale);
}

/// Every element is in one leaf; children tile their parent; boxes and spheres hold all below them.
void expectSoundClusters(const ElementSet& set) {
  for (const Facet& facet : set.facets) {
    EXPECT_EQ(set.clusters[facet.root].elements.first, facet.elements.first);
    EXPECT_EQ(set.clusters[facet.root].elements.end, facet.elements.end);
  }
  std::vector<int> leaves(set.size(), 0);
  for (const Cluster& cluster : set.clusters) {
    const Vec3 u = cluster.bounds[1] - cluster.bounds[0];
    const Vec3 v = cluster.bounds[3] - cluster.bounds[0];
    // Rounding of coordinates of size 1, a few times over.
    constexpr double kRoundingOfPlaces = 1e-15;
    for (Index e = cluster.elements.first; e < cluster.elements.end; ++e) {
      for (const Vec3& corner : set.outline(e)) {
        EXPECT_LE(glm::distance(corner, cluster.centre), cluster.radius + kRoundingOfPlaces);
        const Vec3 p = corner - cluster.bounds[0];
        EXPECT_GE(glm::dot(p, u), -kRoundingOfPlaces);
        EXPECT_GE(glm::dot(p, v), -kRoundingOfPlaces);
        EXPECT_LE(glm::dot(p, u), glm::dot(u, u) + kRoundingOfPlaces);
        EXPECT_LE(glm::dot(p, v), glm::dot(v, v) + kRoundingOfPlaces);
      }
    }
    if (cluster.child_count == 0) {
      ASSERT_EQ(cluster.elements.size(), 1U);
      ++leaves[cluster.elements.first];
      continue;
    }
    EXPECT_GE(cluster.child_count, 2U);
    EXPECT_LE(cluster.child_count, 4U);
    Index at = cluster.elements.first;
    for (Index k = 0; k < cluster.child_count; ++k) {
      const Cluster& child = set.clusters[cluster.first_child + k];
      EXPECT_EQ(child.elements.first, at);
      EXPECT_GT(child.elements.size(), 0U);
      at = child.elements.end;
    }
    EXPECT_EQ(at, cluster.elements.end);
  }
  EXPECT_TRUE(std::all_of(leaves.begin(), leaves.end(), [](int n) { return n == 1; }));
}

TEST(ExactElements, ClosedRoomHasOneElementAPatchAndNoBlackBack) {
  const PatchMesh mesh = test::roomWithBlock(5).build();
  const ElementSet set(mesh);
  ASSERT_EQ(set.size(), mesh.size());
  EXPECT_EQ(set.patch_elements, mesh.size());
  EXPECT_EQ(set.facets.size(), 11U);
  expectSoundClusters(set);
  std::vector<int> seen(mesh.size(), 0);
  for (std::size_t e = 0; e < set.size(); ++e) {
    const Index patch = set.patch[e];
    ++seen[patch];
    const Facet& facet = set.facets[set.facet[e]];
    EXPECT_EQ(facet.polygon, mesh.polygon[patch]);
    EXPECT_NEAR(set.area[e] / (set.scale * set.scale), mesh.area[patch], 1e-15);
    EXPECT_LT(glm::distance(set.centroid[e] / set.scale + set.middle, mesh.centroid[patch]), 1e-15);
    const auto& c = set.corners[e];
    EXPECT_NEAR(glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), facet.normal) / 2, set.area[e] / 2,
                1e-15);
    for (const Vec3& corner : c) {
      EXPECT_NEAR(glm::dot(corner, facet.normal), facet.offset, 1e-15);
      EXPECT_LE(glm::distance(corner, set.centroid[e]), set.radius[e]);
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

TEST(ExactElements, ClustersOfAGridAreSquare) {
  MeshBuilder builder;
  builder.grid("wall", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 8, 8);
  const ElementSet set(builder.build());
  // 1 + 4 + 16 + 64 clusters, each as long as wide.
  EXPECT_EQ(set.clusters.size(), 85U);
  for (const Cluster& cluster : set.clusters) {
    EXPECT_NEAR(glm::distance(cluster.bounds[0], cluster.bounds[1]),
                glm::distance(cluster.bounds[1], cluster.bounds[2]), 1e-15);
  }
}

TEST(ExactElements, ASeenBackIsTiledAroundItsHole) {
  MeshBuilder builder;
  test::floorWithHole(builder, "plate", {0, 0}, {3, 2}, {0.5, 0.75}, {1.25, 1.5}, 1, 2);
  builder.grid("floor", {0, 0, 0}, {3, 0, 0}, {0, 2, 0});
  const PatchMesh mesh = builder.build();
  const ElementSet set(mesh);
  // The floor's back sees nothing: all of the scene is in front. The plate's back sees the floor.
  ASSERT_EQ(set.facets.size(), 3U);
  const Facet& back = set.facets[2];
  EXPECT_TRUE(back.black);
  EXPECT_TRUE(back.back);
  EXPECT_EQ(set.patch_elements, mesh.size());
  EXPECT_NEAR(back.normal.z, -1, 1e-15);
  EXPECT_NEAR(totalArea(set, back), 3 * 2 - 0.75 * 0.75, 1e-14);
  EXPECT_EQ(back.elements.size(), 4U);
  for (Index e = back.elements.first; e < back.elements.end; ++e) {
    EXPECT_EQ(set.patch[e], mesh.size() + mesh.polygons.surface[back.polygon]);
  }
  expectSoundClusters(set);
}

TEST(ExactElements, TwoSidedPolygonsHaveTwoFacets) {
  MeshBuilder builder;
  builder.grid("sheet", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 3, 2, true);
  const PatchMesh mesh = builder.build();
  const ElementSet set(mesh);
  ASSERT_EQ(set.facets.size(), 2U);
  EXPECT_EQ(set.patch_elements, 12U);
  EXPECT_FALSE(set.facets[0].back || set.facets[0].black || set.facets[1].black);
  EXPECT_TRUE(set.facets[1].back);
  EXPECT_EQ(set.facets[0].normal, -set.facets[1].normal);
  for (Index e = 6; e < 12; ++e) EXPECT_EQ(mesh.side[set.patch[e]], 1);
}

TEST(ExactElements, ConcaveAndLargePatchesAreSplitAndDegenerateOnesLeftOut) {
  MeshBuilder builder;
  // Fans from the first corner tile all of these, as the mesh's pieces must.
  builder.polygon("arrow", {{{0.2, 0.2, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}}});  // turns both ways
  builder.polygon("quad", {{{2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0}}});
  builder.polygon("pentagon", {{{4, 0, 0}, {5, 0, 0}, {5.5, 0.5, 0}, {5, 1, 0}, {4, 1, 0}}});
  PatchMesh mesh = builder.build();
  mesh.area[1] = 0;
  mesh.normal[1] = Vec3(0.0);
  mesh.polygon[1] = kNone;
  const ElementSet set(mesh);
  EXPECT_EQ(std::count(set.patch.begin(), set.patch.end(), 0U), 2);
  EXPECT_EQ(std::count(set.patch.begin(), set.patch.end(), 1U), 0);
  EXPECT_EQ(std::count(set.patch.begin(), set.patch.end(), 2U), 2);
  for (const Facet& facet : set.facets) {
    if (!facet.black && facet.polygon == 2) {
      EXPECT_NEAR(totalArea(set, facet), 1.25, 1e-14);
    }
  }
}

TEST(ExactElements, NothingDependsOnNumberingOrAPowerOfTwo) {
  const MeshBuilder builder = test::roomWithBlock(3);
  const PatchMesh mesh = builder.build();
  const ElementSet set(mesh);
  std::vector<std::size_t> order(mesh.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  const ElementSet permuted(builder.build(order));
  PatchMesh large = mesh;
  for (Vec3& v : large.vertices) v *= 1024.0;
  for (Vec3& v : large.centroid) v *= 1024.0;
  for (Vec3& v : large.polygons.origin) v *= 1024.0;
  for (double& area : large.area) area *= 1024.0 * 1024.0;
  const ElementSet scaled(large);
  ASSERT_EQ(permuted.size(), set.size());
  EXPECT_EQ(scaled.scale * 1024, set.scale);
  for (std::size_t e = 0; e < set.size(); ++e) {
    EXPECT_EQ(order[permuted.patch[e]], set.patch[e]);
    EXPECT_EQ(permuted.corners[e], set.corners[e]);
    EXPECT_EQ(scaled.corners[e], set.corners[e]);
    EXPECT_EQ(scaled.area[e], set.area[e]);
  }
}

TEST(ExactElements, ASolidUnseenFromInsideHasNoBlackBacks) {
  MeshBuilder builder;
  builder.box("room", {0, 0, 0}, {4, 4, 4}, 2, true);
  builder.box("block", {1, 1, 1}, {2, 2, 2}, 1);
  EXPECT_EQ(ElementSet(builder.build()).facets.size(), 12U);
  // A patch inside the block sees its backs.
  builder.grid("inside", {1.25, 1.25, 1.5}, {0.5, 0, 0}, {0, 0.5, 0});
  const ElementSet set(builder.build());
  const auto black = std::count_if(set.facets.begin(), set.facets.end(),
                                   [](const Facet& facet) { return facet.black; });
  EXPECT_EQ(black, 6 + 1);
}

TEST(ExactElements, AnEmptyMeshHasNoElements) {
  PatchMesh mesh;
  mesh.corner_offset = mesh.piece_offset = {0};
  mesh.polygons.loop_offset = mesh.polygons.corner_offset = {0};
  EXPECT_EQ(ElementSet(mesh).size(), 0U);
}

double signedArea(const std::vector<Vec2>& loop) {
  double sum = 0;
  for (std::size_t k = 0, last = loop.size() - 1; k < loop.size(); last = k++) {
    sum += cross2(loop[last], loop[k]) / 2;
  }
  return sum;
}

TEST(ConvexPieces, TileStarsWithStarHolesAtEveryTurn) {
  for (int turn = 0; turn < 20; ++turn) {
    std::vector<std::vector<Vec2>> loops(2);
    for (int k = 0; k < 14; ++k) {
      const double angle = 0.1 * turn + 2 * M_PI * k / 14;
      const double r = k % 2 ? 1.0 : 2.0;
      loops[0].push_back({r * std::cos(angle), r * std::sin(angle)});
      loops[1].push_back({0.4 * r * std::cos(-angle), 0.4 * r * std::sin(-angle)});
    }
    const double expected = signedArea(loops[0]) + signedArea(loops[1]);
    double sum = 0;
    for (const auto& piece : convexPieces(loops, 1e-7)) {
      ASSERT_GE(piece.size(), 3U);
      ASSERT_LE(piece.size(), 4U);
      for (std::size_t k = 0; k < piece.size(); ++k) {
        const Vec2& corner = piece[(k + 1) % piece.size()];
        EXPECT_GE(cross2(corner - piece[k], piece[(k + 2) % piece.size()] - corner), -1e-12);
      }
      sum += signedArea(piece);
    }
    EXPECT_NEAR(sum, expected, 1e-12);
  }
}

}  // namespace
}  // namespace radiosity
