// The report of `radiosity info` on a scene: figures, and likely faults by name.
#include <gtest/gtest.h>

#include <numbers>

#include "support/scene_builder.h"
#include "support/scene_files.h"

namespace radiosity::test {
namespace {

/// A room of 2 x 3 x 4 m around the origin's octant, facing inwards, with a lamp panel on it.
struct Room {
  SceneBuilder builder;
  Index walls = builder.surface("walls");
  Index lamp = builder.surface("lamp", 0.5, 10);
  Room() { builder.box(walls, {0, 0, 0}, {2, 3, 4}, false); }
  void hangLamp() { builder.level(lamp, 0.5, 0.5, 1.5, 1.5, 4, false); }
};

std::string problemsOf(const Scene& scene) { return allNotes(inspectScene(scene).problems); }

TEST(SceneInspect, MeasuresSurfaces) {
  SceneBuilder builder;
  const Index sheet = builder.surface("sheet", 0.5, 3, true);
  builder.level(sheet, 0, 0, 2, 1, 0);
  const Index star = builder.surface("ell", 0.5, 5);
  // An L: 2 x 2 less a quarter.
  builder.face(star, {{4, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0}, {5, 2, 0}, {4, 2, 0}});
  const SceneInfo info = inspectScene(builder.scene());
  ASSERT_EQ(info.surfaces.size(), 2u);
  EXPECT_EQ(info.surfaces[0].name, "sheet/sheet");
  EXPECT_EQ(info.surfaces[0].material, "sheet");
  EXPECT_DOUBLE_EQ(info.surfaces[0].area, 2);
  EXPECT_DOUBLE_EQ(info.surfaces[0].emitted_power.x, 2 * 2 * 3) << "both sides emit";
  EXPECT_DOUBLE_EQ(info.surfaces[1].area, 3);
  EXPECT_DOUBLE_EQ(info.surfaces[1].emitted_power.y, 15);
  EXPECT_DOUBLE_EQ(info.emitted_power.z, 27);
  EXPECT_EQ(info.lower, Vec3(0, 0, 0));
  EXPECT_EQ(info.upper, Vec3(6, 2, 0));
  EXPECT_EQ(info.triangles, 2u + 4u);
  EXPECT_FALSE(info.watertight);
  EXPECT_EQ(info.open_edges, 4u + 6u);
}

TEST(SceneInspect, AGoodSceneHasNoProblems) {
  Room room;
  room.hangLamp();
  const Index block = room.builder.surface("block");
  room.builder.box(block, {0.2, 0.2, 0}, {0.7, 0.9, 1});  // stands on the floor
  for (const Scene& scene : {room.builder.scene(), turned(room.builder.scene())}) {
    const SceneInfo info = inspectScene(scene);
    EXPECT_TRUE(info.watertight) << "the room encloses the rest";
    ASSERT_EQ(info.problems.size(), 1u) << allNotes(info.problems);
    EXPECT_NOTE(info.problems, "lamp/lamp overlaps walls/walls in one plane on 1 m^2: the emitter",
                Severity::info);
  }
}

TEST(SceneInspect, ChecksDoNotDependOnScaleOrPlace) {
  Room room;
  room.hangLamp();
  room.builder.box(room.builder.surface("block"), {0.2, 0.2, 0}, {0.7, 0.9, 1}, false);
  const Scene& scene = room.builder.scene();
  // 2^-20 and 2^20 scale exactly, so every comparison comes out the same.
  const std::vector<Scene> variants = {scene, scaled(scene, 0x1p-20), scaled(scene, 0x1p20),
                                       moved(scene, {1e6, -1e6, 1e6})};
  for (const Scene& variant : variants) {
    const SceneInfo info = inspectScene(variant);
    EXPECT_TRUE(info.watertight);
    EXPECT_EQ(info.open_edges, 4u);
    EXPECT_NOTE(info.problems, "block/block: closed, faces inwards and holds nothing",
                Severity::warning);
    EXPECT_NOTE(info.problems, "lamp/lamp overlaps walls/walls", Severity::info);
  }
}

TEST(SceneInspect, TellsClosedScenesFromOpenOnes) {
  Room room;
  EXPECT_TRUE(inspectScene(room.builder.scene()).watertight);
  EXPECT_EQ(inspectScene(room.builder.scene()).open_edges, 0u);
  // The first five faces: a side is missing.
  SceneBuilder open;
  const Index walls = open.surface("walls");
  SceneBuilder whole;
  whole.box(whole.surface("walls"), {0, 0, 0}, {1, 1, 1}, false);
  for (std::size_t f = 0; f < 5; ++f) {
    std::vector<Vec3> corners;
    for (const Index v : whole.scene().face(f)) corners.push_back(whole.scene().vertices[v]);
    open.face(walls, corners);
  }
  const SceneInfo info = inspectScene(open.scene());
  EXPECT_FALSE(info.watertight);
  EXPECT_EQ(info.open_edges, 4u);
  // Something outside the room can see the sky.
  room.builder.level(room.builder.surface("outside"), 5, 5, 6, 6, 0);
  EXPECT_FALSE(inspectScene(room.builder.scene()).watertight);
}

TEST(SceneInspect, WeldsWithinTheToleranceOnly) {
  // The room's diagonal is 5.4 m: 1e-7 of it is 0.54 um.
  for (const auto& [gap, closed] : {std::pair{2e-7, true}, {2e-6, false}}) {
    SceneBuilder builder;
    const Index walls = builder.surface("walls", 0.5, 1);
    builder.box(walls, {0, 0, 0}, {2, 3, 4}, false);
    for (std::size_t k = 20; k < 24; ++k) builder.scene().vertices[k].z += gap;  // the ceiling
    EXPECT_EQ(inspectScene(builder.scene()).watertight, closed) << "gap " << gap;
  }
}

TEST(SceneInspect, NamesMaterialsThatAbsorbNothing) {
  SceneBuilder builder;
  builder.box(builder.surface("snow", 1.0, 1), {0, 0, 0}, {2, 3, 4}, false);
  EXPECT_NOTE(inspectScene(builder.scene()).problems, "reflectance 1: absorbs no light",
              Severity::warning);
  builder.scene().materials[0].reflectance = Vec3(1.0, 1.0, 0.99);
  EXPECT_EQ(problemsOf(builder.scene()), "");
}

TEST(SceneInspect, NamesFacesThatTurnAgainstTheirNeighbours) {
  SceneBuilder builder;
  const Index walls = builder.surface("walls", 0.5, 1);
  const Index door = builder.surface("door");
  builder.box(walls, {0, 0, 0}, {2, 3, 4}, false);
  Scene& scene = builder.scene();
  scene.face_surface[2] = door;
  EXPECT_EQ(problemsOf(scene), "");
  // Turn the door.
  std::swap(scene.corners[scene.face_offset[2] + 1], scene.corners[scene.face_offset[2] + 3]);
  const SceneInfo info = inspectScene(scene);
  EXPECT_NOTE(info.problems, "door/door: 1 of 1 faces turn their backs", Severity::warning);
  EXPECT_EQ(findNote(info.problems, "walls/walls:"), nullptr);
  EXPECT_FALSE(info.watertight);
  // Two-sided, it does not matter.
  for (Material& material : scene.materials) material.two_sided = true;
  EXPECT_EQ(problemsOf(scene), "");
  EXPECT_TRUE(inspectScene(scene).watertight);
}

TEST(SceneInspect, NamesSolidsAndRoomsThatAreInsideOut) {
  // A room that faces outwards hides its contents.
  SceneBuilder outwards;
  outwards.box(outwards.surface("walls"), {0, 0, 0}, {4, 4, 4});
  outwards.box(outwards.surface("lamp", 0.5, 1), {1, 1, 1}, {2, 2, 2});
  EXPECT_NOTE(inspectScene(outwards.scene()).problems,
              "walls/walls: closed, faces outwards and holds lamp/lamp", Severity::loud);
  // A surface of many bodies is named once; the solid's other content is a part of itself.
  SceneBuilder beads;
  const Index shell = beads.surface("shell");
  const Index bead = beads.surface("bead", 0.5, 1);
  beads.box(shell, {0, 0, 0}, {9, 9, 9});
  for (int k = 1; k < 5; ++k) beads.box(bead, {2 * k - 1, 1, 1}, {2 * k, 2, 2});
  beads.box(shell, {1, 4, 1}, {2, 5, 2});
  EXPECT_NOTE(inspectScene(beads.scene()).problems,
              "shell/shell: closed, faces outwards and holds bead/bead, another part of it: a room",
              Severity::loud);
  // A solid may be hollow: its chamber holds something or nothing; things in its wall are gone.
  for (const bool heated : {true, false}) {
    SceneBuilder oven;
    const Index walls = oven.surface("walls");
    oven.box(walls, {0, 0, 0}, {4, 4, 4});
    oven.box(walls, {1, 1, 1}, {3, 3, 3}, false);
    const Index heater = oven.surface("heater", 0.5, 1);
    oven.box(heater, {1.5, 1.5, 1.5}, {2, 2, 2});
    if (!heated) oven.box(oven.surface("lost"), {0.1, 0.1, 0.1}, {0.5, 0.5, 0.5});
    const SceneInfo info = inspectScene(oven.scene());
    if (heated) {
      EXPECT_EQ(findNote(info.problems, "faces"), nullptr);
    } else {
      EXPECT_NOTE(info.problems, "walls/walls: closed, faces outwards and holds lost/lost: a room",
                  Severity::loud);
    }
  }
  SceneBuilder empty;
  empty.box(empty.surface("walls", 0.5, 1), {0, 0, 0}, {4, 4, 4});
  empty.box(empty.surface("chamber"), {1, 1, 1}, {3, 3, 3}, false);
  EXPECT_EQ(problemsOf(empty.scene()), "");
  // A lamp turned inside out keeps its light.
  Room room;
  room.builder.box(room.lamp, {0.5, 0.5, 2}, {1, 1, 3}, false);
  EXPECT_NOTE(inspectScene(room.builder.scene()).problems,
              "lamp/lamp: closed, faces inwards and holds nothing", Severity::loud);
  // A closed room alone is no fault; a solid alone may be a room that faces outwards, unless a
  // camera sees it from outside.
  for (const bool outward : {true, false}) {
    SceneBuilder alone;
    alone.box(alone.surface("cube", 0.5, 1), {0, 0, 0}, {1, 1, 1}, outward);
    const Scene scene = turned(alone.scene());
    if (!outward) {
      EXPECT_EQ(problemsOf(scene), "");
      continue;
    }
    const std::string text =
        "cube/cube: closed, faces outwards and is all there is: nothing inside sees anything; if "
        "it is a room, turn it over, flip='all'";
    EXPECT_NOTE(inspectScene(scene).problems, text, Severity::warning);
    Scene lit = scene;
    lit.lights = {uniformSky({1, 1, 1})};
    EXPECT_NOTE(inspectScene(lit).problems, text, Severity::info);
    Scene seen = scene;
    seen.cameras.emplace_back();
    seen.cameras[0].eye = {9, 9, 9};
    EXPECT_EQ(problemsOf(seen), "");
  }
  // Two rooms, the second empty but for a camera.
  Room with_camera;
  with_camera.hangLamp();
  with_camera.builder.box(with_camera.builder.surface("cell"), {10, 0, 0}, {12, 2, 2}, false);
  EXPECT_NOTE(inspectScene(with_camera.builder.scene()).problems, "cell/cell: closed, faces inw",
              Severity::warning);
  Camera camera;
  camera.eye = {11, 1, 1};
  with_camera.builder.scene().cameras.push_back(camera);
  EXPECT_EQ(findNote(inspectScene(with_camera.builder.scene()).problems, "cell/cell"), nullptr);
}

TEST(SceneInspect, CountsDegenerateDoubledAndBentFaces) {
  Room room;
  room.hangLamp();
  const Index sliver = room.builder.surface("sliver");
  room.builder.face(sliver, {{1, 1, 1}, {1, 1, 1}, {1, 2, 1}});
  room.builder.face(sliver, {{1, 1, 1}, {1, 1.5, 1}, {1, 2, 1}});
  room.builder.face(sliver, {{1, 1, 1}, {1, 2, 1}, {1 + 1e-7, 1.5, 1}});
  room.builder.face(sliver, {{1, 1, 1}, {1, 2, 1}, {1 + 1e-5, 1.5, 1}});
  const Index twin = room.builder.surface("twin");
  room.builder.level(twin, 0.6, 0.6, 1, 1, 2);
  room.builder.face(twin, {{1, 0.6, 2}, {1, 1, 2}, {0.6, 1, 2}, {0.6, 0.6, 2}});
  const Index bent = room.builder.surface("bent");
  room.builder.face(bent, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1.25}, {0, 1, 1}});
  const std::vector<Note> problems = inspectScene(room.builder.scene()).problems;
  EXPECT_NOTE(problems, "sliver/sliver: 3 of 4 faces have no area", Severity::warning);
  EXPECT_NOTE(problems, "twin/twin: faces that are there twice: 1", Severity::warning);
  // One corner is 0.25 above the plane of the other three; any other is less off its own three.
  EXPECT_NOTE(problems, "bent/bent: 1 of 1 faces are not planar, by up to 0.25 m", Severity::info);
}

TEST(SceneInspect, MeasuresOverlapsInOnePlane) {
  SceneBuilder builder;
  const Index floor = builder.surface("floor", 0.5, 1);
  // A concave floor: an L of 3 x 3 less 2 x 2.
  builder.face(floor, {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  const Index rug = builder.surface("rug", 0.2, 1);
  builder.level(rug, 0.5, 0.5, 2, 2, 0);
  for (const Scene& scene : {builder.scene(), turned(builder.scene())}) {
    // Of the rug's 2.25 m^2 the missing corner of the L takes 1.
    EXPECT_NOTE(inspectScene(scene).problems,
                "rug/rug overlaps floor/floor in one plane on 1.25 m^2: the smaller surface",
                Severity::warning);
  }
  // Above by more than coincidence, or beside it: no overlap.
  for (const Vec3& by : {Vec3(0, 0, 1e-5), Vec3(2.5, 2.5, 0)}) {
    Scene scene = builder.scene();
    for (std::size_t v = 6; v < 10; ++v) scene.vertices[v] += by;
    EXPECT_EQ(problemsOf(scene), "");
  }
}

TEST(SceneInspect, NamesFacesFarFromAllOthers) {
  const auto withAStray = [](double distance) {
    Room room;
    const Index stray = room.builder.surface("stray");
    room.builder.level(stray, distance, 0, distance + 1, 1, 2);
    return room.builder.scene();
  };
  for (const Scene& scene : {withAStray(1e6), turned(withAStray(-1e6))}) {
    EXPECT_NOTE(inspectScene(scene).problems, "1 of 7 faces (stray/stray) lie ", Severity::warning);
  }
  EXPECT_EQ(problemsOf(withAStray(1000)).find("from all others"), std::string::npos);
  // Two sheets are as far apart as they look, however thin each is.
  SceneBuilder sheets;
  sheets.level(sheets.surface("lower"), 0, 0, 1, 1, 0);
  sheets.level(sheets.surface("upper"), 0, 0, 1, 1, 3);
  EXPECT_EQ(problemsOf(sheets.scene()).find("from all others"), std::string::npos);
}

TEST(SceneInspect, ReportsALampThatLiesFaceDown) {
  Room room;
  room.builder.level(room.lamp, 0.5, 0.5, 1.5, 1.5, 4, true);
  EXPECT_NOTE(inspectScene(room.builder.scene()).problems,
              "lamp/lamp: 1 of 1 m^2 lie face to face on another surface", Severity::loud);
  // A lamp that stands on the floor covers a sixth of itself.
  Room standing;
  standing.builder.box(standing.lamp, {0.5, 0.5, 0}, {1, 1, 0.5});
  EXPECT_EQ(problemsOf(standing.builder.scene()), "");
}

TEST(SceneInspect, ReportsMissingLight) {
  Room room;
  EXPECT_NOTE(inspectScene(room.builder.scene()).problems, "no surface emits light",
              Severity::info);
  room.builder.face(room.lamp, {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
  const std::vector<Note> problems = inspectScene(room.builder.scene()).problems;
  EXPECT_NOTE(problems, "lamp/lamp emits but has no area", Severity::loud);
  EXPECT_NOTE(problems, "no surface emits light", Severity::info);
}

TEST(SceneInspect, ReportsThatNothingAbsorbs) {
  SceneBuilder builder;
  builder.box(builder.surface("mirror", 1, 1), {0, 0, 0}, {1, 1, 1}, false);
  EXPECT_NOTE(inspectScene(builder.scene()).problems, "light is never absorbed", Severity::loud);
  builder.scene().materials[0].reflectance.y = 0.999;
  EXPECT_EQ(problemsOf(builder.scene()), "");
}

TEST(SceneInspect, ReportsSizesThatSuggestAnotherUnit) {
  Room room;
  room.hangLamp();
  EXPECT_NOTE(inspectScene(scaled(room.builder.scene(), 1000)).problems,
              "the scene measures 5385.16 m across", Severity::warning);
  EXPECT_NOTE(inspectScene(scaled(room.builder.scene(), 0.001)).problems,
              "the scene measures 0.00538516 m across", Severity::warning);
  EXPECT_NOTE(inspectScene(moved(room.builder.scene(), {1e12, 0, 0})).problems, "move it closer",
              Severity::warning);
}

TEST(SceneInspect, RefusesAnEmptyScene) {
  Scene scene;
  scene.file = "nothing.obj";
  EXPECT_CONTAINS(inputErrorOf([&] { inspectScene(scene); }), "nothing.obj: no faces");
}

TEST(SceneInspect, KnowsTheCornellBox) {
  // The published left wall is 3.2 mm off planar in a box of 559 mm; the lamp measures 130 x 105.
  const SceneInfo info =
      inspectScene(loadScene(RADIOSITY_SOURCE_DIR "/data/cornell-box-closed.obj"));
  EXPECT_TRUE(info.watertight);
  EXPECT_NOTE(info.problems, "left_wall/red: 1 of 1 faces are not planar, by up to 0.003",
              Severity::info);
  EXPECT_NOTE(info.problems, "lamp/light overlaps ceiling/white in one plane on 0.01365 m^2",
              Severity::info);
  EXPECT_EQ(info.problems.size(), 2u) << allNotes(info.problems);
  EXPECT_FALSE(inspectScene(loadScene(RADIOSITY_SOURCE_DIR "/data/cornell-box.obj")).watertight);
}

}  // namespace
}  // namespace radiosity::test
