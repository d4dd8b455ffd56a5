#include "figure_scenes.h"

#include "support/scene_builder.h"

namespace radiosity::bench {
namespace {

using test::SceneBuilder;

/// A cube in the middle of another: every shadow's edge is parallel to the cells it crosses.
Scene cubeInCube(double inner) {
  SceneBuilder b;
  b.box(b.surface("outer"), Vec3(-1.0), Vec3(1.0), false);
  b.box(b.surface("inner"), Vec3(-inner), Vec3(inner));
  return b.scene();
}

/// Four posts around a block, as symmetric about four planes.
Scene posts() {
  SceneBuilder b;
  b.box(b.surface("room"), {-2, -2, 0}, {2, 2, 2}, false);
  const Index post = b.surface("post");
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      b.box(post, {x - 0.25, y - 0.25, 0.5}, {x + 0.25, y + 0.25, 1.5});
    }
  }
  b.box(b.surface("block"), {-0.5, -0.5, 0.75}, {0.5, 0.5, 1.25});
  return b.scene();
}

/// Boxes on a floor, against a wall, in a corner, on each other.
Scene touchingBoxes() {
  SceneBuilder b;
  b.box(b.surface("room"), {0, 0, 0}, {4, 4, 3}, false);
  const Index box = b.surface("box");
  b.box(box, {0, 0, 0}, {1, 1, 1});
  b.box(box, {2, 0, 0}, {3, 1, 1.5});
  b.box(box, {2.25, 0.25, 1.5}, {2.75, 0.75, 2});
  b.box(box, {1, 2, 0}, {2, 3, 1});
  b.box(box, {2, 2, 0}, {3, 3, 0.5});
  return b.scene();
}

/// Blades 1 : 400 and 1 : 40 on a floor and in the air.
Scene blades() {
  SceneBuilder b;
  b.box(b.surface("room"), {0, 0, 0}, {4, 4, 3}, false);
  const Index blade = b.surface("blade");
  b.box(blade, {1, 1, 0}, {1.005, 3, 1.5});
  b.box(blade, {2, 1, 0.5}, {2.05, 3, 2.5});
  b.prism(blade, SceneBuilder::turnedRectangle({3, 2}, 2, 0.01, 0.4), 1, 1.02);
  return b.scene();
}

Scene ofData(const std::string& name) {
  return loadScene(RADIOSITY_SOURCE_DIR "/data/" + name + ".obj");
}

}  // namespace

std::vector<FigureScene> figureScenes() {
  std::vector<FigureScene> scenes;
  for (const std::size_t patches : {200, 500}) {
    scenes.push_back({"nested", patches, [] { return cubeInCube(0.5); }});
  }
  scenes.push_back({"nested-thin", 400, [] { return cubeInCube(0.9); }});
  scenes.push_back({"nested-turned", 500, [] { return test::turned(cubeInCube(0.5)); }});
  scenes.push_back({"posts", 400, posts});
  scenes.push_back({"touching", 400, touchingBoxes});
  scenes.push_back({"blades", 400, blades});
  for (const std::size_t patches : {120, 400, 600, 800}) {
    scenes.push_back({"cornell-box-closed", patches, [] { return ofData("cornell-box-closed"); }});
  }
  scenes.push_back({"two-rooms", 500, [] { return ofData("two-rooms"); }});
  return scenes;
}

}  // namespace radiosity::bench
