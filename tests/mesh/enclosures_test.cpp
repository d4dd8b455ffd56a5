// Bodies and rooms: the closed surfaces of a mesh.
#include "mesh/patches/enclosures.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "radiosity/patch_mesh.h"
#include "support/mesh_builder.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using Loop = MeshBuilder::Loop;

Enclosures enclosuresOf(const MeshBuilder& builder) {
  Progress silent;
  return findEnclosures(builder.build(), silent);
}

std::size_t closedSurfaces(const MeshBuilder& builder) {
  return enclosuresOf(builder).surfaces.size();
}

TEST(Enclosures, ARoomWithABlockOnItsFloorIsOneClosedSurface) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const Enclosures found = enclosuresOf(test::roomWithBlock(1));
  ASSERT_EQ(found.surfaces.size(), 1u);
  const ClosedSurface& room = found.surfaces[0];
  EXPECT_EQ(room.polygons.size(), 11u);
  EXPECT_FALSE(room.is_solid);
  // -1 inside the room, 0 in the block and outside: solid angles are exact to rounding.
  EXPECT_NEAR(windingNumber(mesh, room.polygons, {0.1, 0.2, 0.3}), -1, 1e-12);
  EXPECT_NEAR(windingNumber(mesh, room.polygons, {0.4, 0.4, 0.2}), 0, 1e-12);
  EXPECT_NEAR(windingNumber(mesh, room.polygons, {2, 0.5, 0.5}), 0, 1e-12);
}

TEST(Enclosures, OpenFlippedTwoSidedAndCrossingSurfacesEncloseNothing) {
  MeshBuilder open;
  open.box("box", {0, 0, 0}, {1, 1, 1}, 1, false, false);
  EXPECT_EQ(closedSurfaces(open), 0u);

  MeshBuilder flipped;  // one face turned over
  flipped.box("box", {0, 0, 0}, {1, 1, 1}, 1, false, false);
  flipped.grid("bottom", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(closedSurfaces(flipped), 0u);

  MeshBuilder two_sided;
  two_sided.box("box", {0, 0, 0}, {1, 1, 1}, 1, false, false);
  two_sided.grid("bottom", {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, 1, 1, true);
  EXPECT_EQ(closedSurfaces(two_sided), 0u);

  // A prism over a bow tie: closed and oriented, but two of its sides cross, and one of its two
  // chambers is inside out.
  const std::vector<Vec3> tie = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}};
  MeshBuilder crossing;
  Loop top;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 a = tie[k], b = tie[(k + 1) % 4], up(0, 0, 1);
    crossing.polygon("side", {{a, b, b + up, a + up}});
    top.insert(top.begin(), a + up);
  }
  const Loop low(tie.begin(), tie.end());
  const auto addCap = [&](const Loop& loop) {  // two triangles through the crossing's corners
    crossing.polygon("cap", {{loop[0], loop[1], loop[2]}});
    crossing.polygon("cap", {{loop[0], loop[2], loop[3]}});
  };
  addCap(top);
  addCap(low);
  EXPECT_EQ(closedSurfaces(crossing), 0u);
}

// A room whose walls have both sides, as games and glTF have them, turned outward; a cupboard in
// its corner shares parts of edges with it. The edges leave open which sheets belong together.
TEST(Enclosures, ATwoSidedRoomKeepsItsFurnitureInTheCorner) {
  for (const bool outward : {true, false}) {
    for (const double turn : {0.0, 0.7}) {
      test::SceneBuilder builder;
      builder.box(builder.surface("room", 0.5, 0, true), {0, 0, 0}, {5, 4, 2.7}, outward);
      const Index lamp = builder.surface("lamp", 0, 10);
      builder.level(lamp, 2, 1.7, 3, 2.3, 2.6, false);
      builder.box(builder.surface("cupboard"), {4.4, 0, 0}, {5, 1.5, 2});
      Scene scene = builder.scene();
      const Vec3 axis = glm::normalize(Vec3(1, 2, 3));
      for (Vec3& v : scene.vertices) v = test::rotated(v, axis, turn);
      Progress quiet;
      const PatchMesh mesh = meshScene(scene, {.patches = 100}, quiet).mesh;
      double of_lamp = 0;
      for (std::size_t i = 0; i < mesh.size(); ++i) {
        if (mesh.surface_names[mesh.surface[i]] == "lamp/lamp") of_lamp += mesh.area[i];
      }
      EXPECT_NEAR(of_lamp, 0.6, 1e-9) << outward << " " << turn;
    }
  }
}

TEST(Enclosures, ABodyThatFloatsInARoomIsASurfaceOfItsOwn) {
  MeshBuilder builder;
  builder.box("room", {-1, -1, -1}, {1, 1, 1}, 1, true);
  builder.box("cube", {-0.25, -0.25, -0.25}, {0.25, 0.25, 0.25}, 1);
  EXPECT_EQ(closedSurfaces(builder), 2u);
}

bool provesClosed(const MeshBuilder& builder) { return enclosuresOf(builder).closed; }

TEST(Enclosures, ASceneIsClosedIfEveryPatchIsOnOrInARoom) {
  EXPECT_TRUE(provesClosed(test::roomWithBlock(2)));
  MeshBuilder inside;  // a block within a room, apart from it
  inside.box("room", {0, 0, 0}, {1, 1, 1}, 1, true);
  inside.box("block", {0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}, 1);
  EXPECT_TRUE(provesClosed(inside));
  MeshBuilder outside;
  outside.box("room", {0, 0, 0}, {1, 1, 1}, 1, true);
  outside.box("block", {2.4, 0.4, 0.4}, {2.6, 0.6, 0.6}, 1);
  EXPECT_FALSE(provesClosed(outside));
  MeshBuilder open;
  open.box("room", {0, 0, 0}, {1, 1, 1}, 1, true, false);
  EXPECT_FALSE(provesClosed(open));
  EXPECT_FALSE(provesClosed(MeshBuilder()));
}

/// The patches of a scene, by surface, that are enclosed.
struct Enclosed {
  bool closed = false;
  std::vector<std::size_t> yes;
  std::vector<std::size_t> no;
};

Enclosed enclosedIn(const Scene& scene, bool faces) {
  MeshOptions options;
  options.patches = 60;
  options.faces_as_patches = faces;
  Progress silent;
  const PatchMesh mesh = meshScene(scene, options, silent).mesh;
  Enclosed found{mesh.enclosures->closed, std::vector<std::size_t>(scene.surfaces.size()),
                 std::vector<std::size_t>(scene.surfaces.size())};
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    ++(mesh.enclosures->enclosed[i] != 0 ? found.yes : found.no)[mesh.surface[i]];
  }
  return found;
}

/// The scene as it is, turned, and at other sizes and places.
std::vector<Scene> placed(const Scene& scene) {
  return {scene, test::turned(scene), test::turned(test::scaled(scene, 1e-6)),
          test::scaled(scene, 1e6), test::moved(test::turned(scene), {1e4, -2e4, 3e4})};
}

TEST(Enclosures, FurnitureLampsAndSheetsInARoomAreClosedIn) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), {0, 0, 0}, {5, 4, 2.7}, false);
  builder.box(builder.surface("cupboard"), {4.4, 0, 0}, {5, 1.5, 2});  // in a corner
  builder.box(builder.surface("table"), {1, 1, 0}, {2, 2, .7});
  builder.box(builder.surface("vase"), {1.4, 1.4, .7}, {1.5, 1.5, 1});
  builder.level(builder.surface("lamp", 0, 1), 2, 2, 3, 3, 2.5, false);     // in the air
  builder.level(builder.surface("panel", 0, 1), 1, 3, 2, 3.5, 2.7, false);  // on the ceiling
  builder.face(builder.surface("screen", .5, 0, true),
               {{3, 0, 0}, {3, 2, 0}, {3, 2, 2}, {3, 0, 2}});  // from the wall
  for (const Scene& scene : placed(builder.scene())) EXPECT_TRUE(enclosedIn(scene, false).closed);
}

TEST(Enclosures, TwoRoomsThatShareAWallAreClosedEachByItself) {
  test::SceneBuilder builder;
  builder.box(builder.surface("left"), {0, 0, 0}, {2, 2, 2}, false);
  builder.box(builder.surface("right"), {2, 0, 0}, {3, 2, 2}, false);
  for (const Scene& scene : placed(builder.scene())) {
    for (const bool faces : {false, true}) EXPECT_TRUE(enclosedIn(scene, faces).closed) << faces;
  }
}

// Each of the shells is open, and together they close: four walls, a floor, a roof that overhangs.
TEST(Enclosures, SurfacesThatTogetherCloseEncloseWhatIsBetween) {
  test::SceneBuilder builder;
  builder.level(builder.surface("ground"), -1, -1, 3, 3, 0);
  const Index walls = builder.surface("walls", .5, 0, true);
  builder.face(walls, {{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}});
  builder.face(walls, {{2, 0, 0}, {2, 2, 0}, {2, 2, 1}, {2, 0, 1}});
  builder.face(walls, {{2, 2, 0}, {0, 2, 0}, {0, 2, 1}, {2, 2, 1}});
  builder.face(walls, {{0, 2, 0}, {0, 0, 0}, {0, 0, 1}, {0, 2, 1}});
  builder.level(builder.surface("roof"), -.5, -.5, 2.5, 2.5, 1, false);
  const Index lamp = builder.surface("lamp", 0, 1);
  builder.level(lamp, .5, .5, 1, 1, .8, false);
  for (const Scene& scene : placed(builder.scene())) {
    const Enclosed found = enclosedIn(scene, false);
    EXPECT_FALSE(found.closed);
    EXPECT_GT(found.no[0], 0u) << "ground outside";
    EXPECT_GT(found.yes[1], 0u) << "walls inside";
    EXPECT_GT(found.no[1], 0u) << "walls outside";
    EXPECT_EQ(found.no[3], 0u) << "the lamp is inside";
  }
}

TEST(Enclosures, WhatPassesThroughAWallIsNotClosedIn) {
  for (const bool body : {true, false}) {
    test::SceneBuilder builder;
    builder.box(builder.surface("room"), {0, 0, 0}, {2, 1.5, 1}, false);
    const Index lamp = builder.surface("lamp", 0, 1);
    if (body) {
      builder.box(lamp, {1.7, .6, .4}, {2.4, .8, .6});
    } else {
      // As high as the wall: nothing pierces its inside.
      builder.face(lamp, {{1.7, .6, 0}, {2.4, .6, 0}, {2.4, .6, 1}, {1.7, .6, 1}});
    }
    for (const Scene& scene : placed(builder.scene())) {
      for (const bool faces : {false, true}) {
        const Enclosed found = enclosedIn(scene, faces);
        EXPECT_EQ(found.no[0], 0u) << "walls";
        EXPECT_GT(found.no[1], 0u) << "lamp";
        EXPECT_FALSE(found.closed);
      }
    }
  }
}

// Its patches meet on an edge in the wall, which is not cut there.
TEST(Enclosures, APlateThatAWallHalvesIsNotClosedIn) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), {0, 0, 0}, {2, 1.5, 1}, false);
  const Index lamp = builder.surface("lamp", 0, 1);
  builder.face(lamp, {{1.8, .6, .5}, {2, .6, .5}, {2, .8, .5}, {1.8, .8, .5}});
  builder.face(lamp, {{2, .6, .5}, {2.2, .6, .5}, {2.2, .8, .5}, {2, .8, .5}});
  for (const Scene& scene : placed(builder.scene())) {
    for (const bool faces : {false, true}) {
      const Enclosed found = enclosedIn(scene, faces);
      EXPECT_EQ(found.no[0], 0u) << "walls";
      EXPECT_EQ(found.no[1], 1u) << "the half outside";
      EXPECT_FALSE(found.closed);
    }
  }
}

// Faces as patches meet where one has a corner on the edge of another, or lie on each other.
TEST(Enclosures, FacesAsPatchesMayHaveTJunctionsButNotLieFaceToFace) {
  test::SceneBuilder builder;
  const Index room = builder.surface("room");
  builder.prism(room, {{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0, 1, false);
  Scene scene = builder.scene();
  test::SceneBuilder halves;  // the ceiling in two parts: their common edge ends inside others
  const Index of = halves.surface("room");
  for (std::size_t f = 0; f + 1 < scene.faceCount(); ++f) {
    std::vector<Vec3> corners;
    for (const Index v : scene.face(Index(f))) corners.push_back(scene.vertices[v]);
    halves.face(of, corners);
  }
  halves.level(of, 0, 0, .7, 1, 1, false);
  halves.level(of, .7, 0, 2, 1, 1, false);
  for (const Scene& part : placed(halves.scene())) EXPECT_TRUE(enclosedIn(part, true).closed);
  halves.box(halves.surface("block"), {.2, .3, 0}, {.6, .7, .5});
  for (const Scene& part : placed(halves.scene())) {
    const Enclosed found = enclosedIn(part, true);
    EXPECT_EQ(found.no[0], 0u);
    EXPECT_EQ(found.no[1], 1u) << "its bottom";
    EXPECT_TRUE(enclosedIn(part, false).closed);
  }
}

TEST(Enclosures, AGapIsAGapAtAnySize) {
  for (const double gap : {1e-1, 1e-3, 1e-5, 1e-6}) {
    test::SceneBuilder builder;
    const Index room = builder.surface("room");
    builder.prism(room, {{0, 0}, {2, 0}, {2, 1}, {0, 1}}, 0, 1, false);
    Scene scene = builder.scene();
    for (const Index v : scene.face(5)) scene.vertices[v].z += gap;  // the ceiling
    for (const Scene& part : placed(scene)) {
      for (const bool faces : {false, true}) EXPECT_FALSE(enclosedIn(part, faces).closed) << gap;
    }
  }
}

TEST(Enclosures, APolygonIsCoveredByOneOnTheSameCornersThatFacesTheOtherWay) {
  MeshBuilder builder;
  builder.grid("above", {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("below", {0, 0, 0}, {0, 1, 0}, {1, 0, 0});
  builder.grid("alone", {0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  const Enclosures found = enclosuresOf(builder);
  EXPECT_EQ(found.covered, (std::vector<std::uint8_t>{1, 1, 0}));
  // The two enclose nothing.
  EXPECT_TRUE(found.surfaces.empty());
  EXPECT_FALSE(found.closed);
}

TEST(Enclosures, MeshingFindsThemAtAnySizeAndTurn) {
  test::SceneBuilder builder;
  builder.box(builder.surface("room"), {0, 0, 0}, {3, 2, 2}, false);
  builder.box(builder.surface("on the floor"), {0.5, 0.5, 0}, {1, 1, 0.5});
  builder.box(builder.surface("in the air"), {2, 1, 1}, {2.5, 1.5, 1.5});
  const Scene straight = builder.scene();
  for (const Scene& scene : {straight, test::turned(straight), test::scaled(straight, 1e-6),
                             test::turned(test::scaled(straight, 1e6))}) {
    for (const bool faces : {false, true}) {
      MeshOptions options;
      options.patches = 100;
      options.faces_as_patches = faces;
      Progress silent;
      const PatchMesh mesh = meshScene(scene, options, silent).mesh;
      ASSERT_TRUE(mesh.enclosures.has_value());
      // Faces as patches do not tell that the room and the box on its floor are one surface.
      EXPECT_EQ(mesh.enclosures->surfaces.size(), faces ? 3u : 2u);
      // Nor do they see the floor that the box stands on.
      EXPECT_EQ(mesh.enclosures->closed, !faces);
    }
  }
}

}  // namespace
}  // namespace radiosity
