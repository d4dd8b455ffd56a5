// The likeliest lamp of a scene.
#include <gtest/gtest.h>

#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

TEST(LikelyLamp, IsFoundByTheNameOfItsMaterial) {
  for (const std::string name : {"Lamp", "ceiling_light.003", "DeskLamp02", "bulb", "emitter",
                                 "Emissive_white", "neon-lights"}) {
    SceneBuilder builder;
    builder.level(builder.surface("wall"), 0, 0, 1, 1, 0);
    builder.level(builder.surface("light_wood_floor"), 0, 0, 1, 1, 0);
    builder.level(builder.surfaceOf("thing", builder.material(name)), 0, 0, 1, 1, 1);
    EXPECT_EQ(likelyLamp(builder.scene()), name);
  }
}

TEST(LikelyLamp, IsFoundByTheNameOfItsObject) {
  SceneBuilder builder;
  const Index white = builder.material("white");
  builder.level(builder.surfaceOf("flight of stairs", white), 0, 0, 1, 1, 0);
  builder.level(builder.surfaceOf("floor lamp", white), 0, 0, 1, 1, 1);
  EXPECT_EQ(likelyLamp(builder.scene()), "floor lamp/white");
}

TEST(LikelyLamp, IsNotALightShadeOfAMaterial) {
  SceneBuilder builder;
  builder.level(builder.surface("metalDark"), 0, 0, 1, 1, 0);
  builder.level(builder.surface("metalLight"), 0, 0, 1, 1, 1);
  builder.level(builder.surface("Wood.light"), 0, 0, 1, 1, 2);
  builder.level(builder.surface("wood"), 0, 0, 1, 1, 3);
  EXPECT_EQ(likelyLamp(builder.scene()), "metalDark/metalDark");  // the first surface
  builder.level(builder.surface("deskLight"), 0, 0, 1, 1, 4);
  EXPECT_EQ(likelyLamp(builder.scene()), "deskLight");
}

TEST(LikelyLamp, IsNoFloorAndNoWallsOfALightColour) {
  // By the name of the object and of the material; the panel alone is like a lamp.
  for (const bool by_object : {true, false}) {
    for (const std::string part : {"floor", "walls"}) {
      for (const bool with_panel : {true, false}) {
        SceneBuilder builder;
        builder.scene().up = Up::z;
        const auto surface = [&](const std::string& name) {
          return by_object
                     ? builder.surfaceOf(name == part ? "Light" : name, builder.material(name))
                     : builder.surfaceOf(name, builder.material(name == part ? "Light" : name));
        };
        const Index walls = surface("walls");
        builder.face(walls, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
        builder.face(walls, {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
        builder.face(walls, {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
        builder.face(walls, {{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
        builder.level(surface("floor"), 0, 0, 4, 4, 0);
        builder.level(surface("top"), 0, 0, 4, 4, 3, false);
        if (with_panel) builder.level(builder.surface("ceiling light"), 1, 1, 2, 2, 2.9, false);
        EXPECT_EQ(likelyLamp(builder.scene()), with_panel ? "ceiling light" : "top/top")
            << part << by_object;
      }
    }
  }
}

TEST(LikelyLamp, IsTheCeilingIfNoNameTells) {
  SceneBuilder named;
  named.level(named.surface("floor"), 0, 0, 1, 1, 0);
  named.level(named.surfaceOf("Ceiling", named.material("white")), 0, 0, 1, 1, 1);
  EXPECT_EQ(likelyLamp(named.scene()), "Ceiling/white");
  // No name tells: the larger of two surfaces that face down, y being up; not a table's underside.
  SceneBuilder builder;
  const Index walls = builder.surface("a");
  const Index small = builder.surface("b");
  const Index large = builder.surface("c");
  const Index table = builder.surface("d");
  const auto down = [&](Index s, double size, double y) {
    builder.face(s, {{0, y, 0}, {size, y, 0}, {size, y, size}, {0, y, size}});
  };
  builder.box(walls, {0, 0, 0}, {4, 3, 4}, false);
  down(small, 1, 2.9);
  down(large, 2, 2.95);
  down(table, 3, 0.7);
  EXPECT_EQ(likelyLamp(builder.scene()), "c/c");
  // The same standing on z.
  for (Vec3& p : builder.scene().vertices) p = {p.x, -p.z, p.y};
  builder.scene().up = Up::z;
  EXPECT_EQ(likelyLamp(builder.scene()), "c/c");
}

TEST(LikelyLamp, IsTheFirstSurfaceIfNothingElseTells) {
  SceneBuilder builder;
  builder.level(builder.surface("teapot"), 0, 0, 1, 1, 0);
  EXPECT_EQ(likelyLamp(builder.scene()), "teapot/teapot");
  EXPECT_EQ(likelyLamp(Scene()), "");
}

}  // namespace
}  // namespace radiosity
