// Grids over surfaces and planes, points from tables, and plans.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>

#include "base/srgb.h"
#include "radiosity/illuminance.h"
#include "render/colour_map.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MeasuringGrid, SpacingIsThatOfTheStandard) {
  // EN 12464-1, table of typical grids: .4 x .4 m: .15; .6: .2; 1: .2; 2: .3; 5: .6; 10: 1; 25: 2;
  // 50: 3; 100: 5. The standard rounds freely.
  EXPECT_NEAR(standardSpacing(1, 1), 0.2, 1e-12);
  EXPECT_NEAR(standardSpacing(10, 10), 1, 1e-12);
  EXPECT_NEAR(standardSpacing(100, 100), 5, 1e-12);
  EXPECT_NEAR(standardSpacing(2, 2), 0.3, 0.03);
  EXPECT_NEAR(standardSpacing(25, 25), 2, 0.12);
  // A strip: of its shorter side.
  EXPECT_EQ(standardSpacing(20, 10), standardSpacing(10, 10));
  EXPECT_EQ(standardSpacing(1e6, 1e6), 10);
}

TEST(MeasuringGrid, AFloorHasItsPointsAtTheMiddlesOfCells) {
  SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 6, 4, 0.5);
  builder.scene().up = Up::z;
  const MeasuringPoints points = pointsOverSurface(builder.scene(), "floor", 0.8);
  ASSERT_TRUE(points.grid.has_value());
  // d = 6 m: .2 * 5^lg 6 = .6997 m; 6 / .6997 = 8.6, 4 / .6997 = 5.7.
  EXPECT_EQ(points.grid->columns, 9U);
  EXPECT_EQ(points.grid->rows, 6U);
  EXPECT_EQ(points.size(), 54U);
  EXPECT_NEAR(glm::distance(points.at[0], Vec3(6.0 / 18, 4.0 / 12, 1.3)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(points.at[53], Vec3(6 - 6.0 / 18, 4 - 4.0 / 12, 1.3)), 0, 1e-12);
  EXPECT_EQ(points.normal[7], Vec3(0, 0, 1));
  EXPECT_EQ(points.grid->u, Vec3(1, 0, 0));
  EXPECT_EQ(points.grid->v, Vec3(0, 1, 0));
}

TEST(MeasuringGrid, AGivenSpacingIsKept) {
  SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 2, 1.1, 0);
  builder.scene().up = Up::z;
  const MeasuringPoints points = pointsOverSurface(builder.scene(), "floor", 0, 0.5);
  EXPECT_EQ(points.grid->columns, 4U);
  EXPECT_EQ(points.grid->rows, 2U);
  // What is left over is border, alike on both sides.
  EXPECT_NEAR(glm::distance(points.at[0], Vec3(0.25, 0.3, 0)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(points.at[5], Vec3(0.75, 0.8, 0)), 0, 1e-12);
}

TEST(MeasuringGrid, PointsKeepToTheOutline) {
  // An L of three unit squares: as one concave face, and as triangles.
  const std::vector<Vec3> outline = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                     {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  SceneBuilder whole;
  whole.face(whole.surface("floor"), outline);
  SceneBuilder parts;
  const Index floor = parts.surface("floor");
  for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
    parts.face(floor, {outline[std::size_t(a)], outline[std::size_t(b)], outline[std::size_t(c)]});
  }
  for (SceneBuilder* builder : {&whole, &parts}) {
    builder->scene().up = Up::z;
    const MeasuringPoints points = pointsOverSurface(builder->scene(), "floor", 0, 0.1);
    EXPECT_EQ(points.size(), 300U);  // of 400 in the square around it
    for (const Vec3& p : points.at) EXPECT_FALSE(p.x > 1 && p.y > 1);
  }
}

TEST(MeasuringGrid, ATurnedFloorKeepsItsRows) {
  SceneBuilder builder;
  builder.level(builder.surface("floor"), 0, 0, 5, 3, 0);
  const Vec3 axis(0, 0, 1);
  for (Vec3& p : builder.scene().vertices) p = test::rotated(p, axis, 0.4);
  builder.scene().up = Up::z;
  const MeasuringPoints points = pointsOverSurface(builder.scene(), "floor", 0, 0.5);
  EXPECT_EQ(points.size(), 60U);
  EXPECT_NEAR(glm::distance(points.grid->u, test::rotated({1, 0, 0}, axis, 0.4)), 0, 1e-12);
}

TEST(MeasuringGrid, WallsStandUpright) {
  for (const Up up : {Up::y, Up::z}) {
    SceneBuilder builder;
    const Vec3 above = up == Up::y ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
    const Vec3 along = glm::cross(above, Vec3(1, 0, 0));
    builder.face(builder.surface("wall"),
                 {Vec3(0), 4.0 * along, 4.0 * along + 3.0 * above, 3.0 * above});
    builder.scene().up = up;
    const MeasuringPoints points = pointsOverSurface(builder.scene(), "wall", 0.1, 1);
    EXPECT_NEAR(glm::distance(points.grid->v, above), 0, 1e-12);
    EXPECT_EQ(points.grid->columns, 4U);
    EXPECT_EQ(points.grid->rows, 3U);
    // Below 0: over the other side, which it faces.
    const MeasuringPoints behind = pointsOverSurface(builder.scene(), "wall", -0.1, 1);
    EXPECT_NEAR(glm::distance(behind.normal[0], -points.normal[0]), 0, 1e-12);
    EXPECT_NEAR(glm::dot(behind.at[0], points.normal[0]), -0.1, 1e-12);
  }
}

TEST(MeasuringGrid, OfABoxTheTopIsMeant) {
  SceneBuilder builder;
  builder.box(builder.surface("table"), {0, 0, 0}, {2, 1, 0.7});
  builder.scene().up = Up::z;
  const MeasuringPoints points = pointsOverSurface(builder.scene(), "table", 0, 0.5);
  EXPECT_EQ(points.size(), 8U);
  EXPECT_NEAR(points.at[3].z, 0.7, 1e-12);
  ASSERT_EQ(points.notes.size(), 1U);
}

TEST(MeasuringGrid, OfAThinBoardTheUpperSideIsMeant) {
  // A table top 2 cm thick, whose bottom comes first in the file; level and tilted.
  for (const double tilt : {0.0, 0.3}) {
    SceneBuilder builder;
    builder.box(builder.surface("top"), {0, 0, 0.7}, {2, 1, 0.72});
    const Vec3 axis(1, 0, 0);
    for (Vec3& p : builder.scene().vertices) p = test::rotated(p, axis, tilt);
    builder.scene().up = Up::z;
    const Vec3 normal = test::rotated({0, 0, 1}, axis, tilt);
    const MeasuringPoints points = pointsOverSurface(builder.scene(), "top", 0.1, 0.5);
    EXPECT_EQ(points.size(), 8U);
    EXPECT_NEAR(glm::distance(points.normal[0], normal), 0, 1e-12);
    for (const Vec3& p : points.at) EXPECT_NEAR(glm::dot(p, normal), 0.82, 1e-12);
    ASSERT_EQ(points.notes.size(), 1U);
    EXPECT_EQ(points.notes[0].text,
              "grid: top is a thin board; its points stand over the 1 of its 6 faces that face up");
  }
}

TEST(MeasuringGrid, AnUprightBoardIsAskedForItsSide) {
  SceneBuilder builder;
  builder.box(builder.surface("screen"), {0, 0, 0}, {2, 0.01, 1.5});
  builder.scene().up = Up::z;
  EXPECT_EQ(errorOf([&] { pointsOverSurface(builder.scene(), "screen"); }),
            "grid: screen is a thin board, and neither of its sides faces up; name a surface that "
            "is one side, or give a plane by three corners");
}

TEST(MeasuringGrid, AFaceThatIsTurnedWronglyIsToldAndLeftOut) {
  // A ceiling, of which a tile in a corner faces up.
  SceneBuilder builder;
  const Index ceiling = builder.surface("ceiling");
  builder.level(ceiling, 0, 0, 1, 1, 3);
  builder.level(ceiling, 0, 1, 1, 3, 3, false);
  builder.level(ceiling, 1, 0, 4, 3, 3, false);
  builder.scene().up = Up::z;
  const MeasuringPoints points = pointsOverSurface(builder.scene(), "ceiling", 0, 0.5);
  EXPECT_EQ(points.size(), 48U - 4U);
  EXPECT_EQ(points.normal[0], Vec3(0, 0, -1));
  ASSERT_EQ(points.notes.size(), 1U);
  EXPECT_EQ(points.notes[0].text,
            "grid: 1 of the 3 faces of ceiling faces the other way and is left out");
}

TEST(MeasuringGrid, NoPointIsLostBetweenTriangles) {
  // Rectangles of two triangles, as they stand and turned: many points are on their diagonals.
  const Vec3 axis = glm::normalize(Vec3(1, 2, 3));
  int lost = 0;
  for (int width = 5; width <= 80; ++width) {
    for (int depth = 5; depth <= width; depth += 3) {
      for (const double turn : {0.0, 0.7}) {
        const double x = 0.1 * width;
        const double y = 0.1 * depth;
        std::array<Vec3, 4> corners = {Vec3(0), {x, 0, 0}, {x, y, 0}, {0, y, 0}};
        for (Vec3& p : corners) p = test::rotated(p, axis, turn);
        SceneBuilder builder;
        const Index floor = builder.surface("floor");
        builder.face(floor, {corners[0], corners[1], corners[2]});
        builder.face(floor, {corners[2], corners[3], corners[0]});
        builder.scene().up = Up::z;
        const MeasuringPoints points = pointsOverSurface(builder.scene(), "floor");
        lost += int(points.grid->columns * points.grid->rows - points.size());
      }
    }
  }
  EXPECT_EQ(lost, 0);
}

TEST(MeasuringGrid, APatternHasAGridForEachSurface) {
  SceneBuilder builder;
  builder.face(builder.surface("wall_1"), {{0, 0, 0}, {4, 0, 0}, {4, 0, 3}, {0, 0, 3}});
  builder.face(builder.surface("wall_2"), {{0, 0, 0}, {0, 0, 3}, {0, 2, 3}, {0, 2, 0}});
  const Index tile = builder.material("tile");
  builder.level(builder.surfaceOf("floor_1", tile), 0, 0, 2, 2, 0);
  builder.level(builder.surfaceOf("floor_2", tile), 2, 0, 4, 2, 0);
  // A corridor so narrow that its walls are within a percent of its length.
  builder.face(builder.surface("side_1"), {{0, 0, 0}, {99, 0, 0}, {99, 0, 3}, {0, 0, 3}});
  builder.face(builder.surface("side_2"), {{0, 0.9, 0}, {0, 0.9, 3}, {99, 0.9, 3}, {99, 0.9, 0}});
  Scene& scene = builder.scene();
  scene.up = Up::z;
  const std::vector<MeasuringPoints> walls = pointsOverSurfaces(scene, "wall*", 0.1, 1);
  ASSERT_EQ(walls.size(), 2U);
  EXPECT_EQ(walls[0].name, "wall_1/wall_1 + 0.1 m");
  EXPECT_EQ(walls[0].size(), 12U);
  EXPECT_EQ(walls[0].normal[0], Vec3(0, -1, 0));
  EXPECT_EQ(walls[1].size(), 6U);
  EXPECT_EQ(walls[1].normal[0], Vec3(-1, 0, 0));
  // What is in one plane, and what has that name itself, stays one.
  const std::vector<MeasuringPoints> floor = pointsOverSurfaces(scene, "floor*", 0, 1);
  ASSERT_EQ(floor.size(), 1U);
  EXPECT_EQ(floor[0].name, "floor*");
  EXPECT_EQ(floor[0].size(), 8U);
  EXPECT_EQ(pointsOverSurfaces(scene, "tile", 0, 1).size(), 1U);
  EXPECT_EQ(pointsOverSurfaces(scene, "side*", 0, 1).size(), 2U);

  const Index lamp = builder.surface("wall_lamp");
  builder.box(lamp, {1, 0, 2}, {1.2, 0.1, 2.2});
  builder.level(lamp, 1, 0, 1.2, 0.1, 3);
  const auto over = [&](const std::string& name) {
    return errorOf([&] { pointsOverSurfaces(scene, name); });
  };
  EXPECT_EQ(over("wall*"),
            "grid: wall_lamp/wall_lamp is not planar, nor are its faces that face up; name a "
            "planar surface, or give a plane by three corners (it is one of the 3 surfaces that "
            "wall* means)");
  EXPECT_NE(over("roof*").find("no surface, material or object matches roof*"), std::string::npos);
}

TEST(MeasuringGrid, WhatIsNoPlaneIsRefused) {
  SceneBuilder builder;
  const Index stairs = builder.surface("stairs");
  builder.level(stairs, 0, 0, 1, 1, 0);
  builder.level(stairs, 1, 0, 2, 1, 0.2);
  builder.face(builder.surface("thread"), {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  builder.level(builder.surface("floor"), 0, 0, 100, 100, 0);
  Scene& scene = builder.scene();
  scene.up = Up::z;
  const auto over = [&](const std::string& name, std::optional<double> spacing = {}) {
    return errorOf([&] { pointsOverSurface(scene, name, 0, spacing); });
  };
  EXPECT_NE(over("stairs").find("not planar"), std::string::npos);
  EXPECT_NE(over("thread").find("no area"), std::string::npos);
  EXPECT_NE(over("flor").find("there are: floor"), std::string::npos) << over("flor");
  EXPECT_NE(over("floor", 0.05).find("at most 1,000,000"), std::string::npos);
  EXPECT_NE(over("floor", -1).find("no distance"), std::string::npos);
  EXPECT_NE(errorOf([] {
              pointsOnPlane({Vec3(0), Vec3(1, 0, 0), Vec3(2, 0, 0)});
            }).find("in one line"),
            std::string::npos);
}

TEST(MeasuringGrid, APlaneFacesWhereItsCornersTurnLeft) {
  const MeasuringPoints points = pointsOnPlane({Vec3(0, 0, 1), Vec3(2, 0, 1), Vec3(2, 3, 1)}, 1);
  EXPECT_EQ(points.size(), 6U);
  EXPECT_EQ(points.normal[0], Vec3(0, 0, 1));
  EXPECT_NEAR(glm::distance(points.at[5], Vec3(1.5, 2.5, 1)), 0, 1e-12);
}

TEST(MeasuringGrid, PointsAreReadWithAndWithoutAHeader) {
  const std::string path = (std::filesystem::temp_directory_path() / "points_test.csv").string();
  const auto read = [&](const std::string& text) {
    std::ofstream(path) << text;
    return readMeasuringPoints(path, Up::z);
  };
  const MeasuringPoints plain = read("1,2,3\n4,5,6\n");
  ASSERT_EQ(plain.size(), 2U);
  EXPECT_EQ(plain.at[0], Vec3(1, 2, 3));
  EXPECT_EQ(plain.normal[1], Vec3(0, 0, 1));
  const MeasuringPoints named = read("# desks\nnx,ny,nz,x_m,y_m,z_m,name\n2,0,0,1,2,3,left\n");
  EXPECT_EQ(named.at[0], Vec3(1, 2, 3));
  EXPECT_EQ(named.normal[0], Vec3(1, 0, 0));
  const auto error = [&](const std::string& text) { return errorOf([&] { read(text); }); };
  EXPECT_NE(error("1,2,3\n4,5,six\n").find(":2: `six` in column z"), std::string::npos);
  EXPECT_NE(error("x,y\n1,2\n").find(":1: there is no column z"), std::string::npos);
  EXPECT_NE(error("x,y,z,nx\n1,2,3,4\n").find(":1: nx, ny and nz are not all there"),
            std::string::npos);
  EXPECT_NE(error("1,2,3,0,0,0\n").find(":1: the normal is 0,0,0"), std::string::npos);
  EXPECT_NE(error("1,2,3\n4,5\n").find(":2: 2 fields, and the first line has 3"),
            std::string::npos);
  std::filesystem::remove(path);
}

/// A plan whose points get 100 lx for each metre of x.
TEST(IlluminancePlan, ColoursAndLinesStandWhereTheValuesAre) {
  const MeasuringPoints points = pointsOnPlane({Vec3(0), Vec3(10, 0, 0), Vec3(10, 4, 0)}, 1);
  PointLightValues light;
  light.bands = 1;
  light.up = Up::z;
  light.error.assign(points.size(), 0.0);
  light.inside.assign(points.size(), 0);
  light.direct.assign(points.size() * kMeasured, 0.0);
  light.indirect.assign(light.direct.size(), 0.0);
  for (std::size_t k = 0; k < points.size(); ++k) {
    light.direct[k * kMeasured] = 100 * points.at[k].x / kLumensPerWatt;
  }
  light.inside[0] = 1;
  const Image image = illuminancePlan(points, light, 0);
  // 10 x 4 m at 120 pixels a metre, the plan in the middle.
  ASSERT_EQ(image.width, 1200 + 32);
  const auto pixel = [&](int x, int y) {
    return image.rgba.data() + (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * 4;
  };
  int top = 0;
  while (pixel(16 + 600, top)[2] > 0.99F || pixel(16 + 1199, top)[2] > 0.99F) ++top;
  // From 150 lx at x = 1.5 m, since the first point stands in a body, to 950 lx.
  const ColourMap map;
  for (const double x : {3.3, 6.2, 8.7}) {
    const double lux = 100 * x;
    const Vec3 colour = map.at((lux - 50) / 900);
    const float* p = pixel(16 + int(120 * x), top + 20);
    // Pixels are .8 lx wide.
    for (int b = 0; b < 3; ++b) EXPECT_NEAR(p[b], srgbFromLinear(colour[b]), 5e-3) << x;
  }
  // 900 lx in ten lines at most: every 100 lx, at whole metres.
  for (int metre = 2; metre <= 9; ++metre) {
    // Black, or white over dark colours.
    float farthest = 0;
    for (int x = -2; x <= 2; ++x) {
      const float green = pixel(16 + 120 * metre + x, top + 20)[1];
      farthest = std::max(farthest, std::abs(green - 0.5F));
    }
    EXPECT_FLOAT_EQ(farthest, 0.5F) << metre;
  }
  // The body at the lower left is grey.
  const float* body = pixel(16 + 10, top + 479);
  EXPECT_EQ(body[0], body[1]);
  EXPECT_EQ(body[1], body[2]);
  EXPECT_GT(body[0], 0.5F);
  const Image ranged = illuminancePlan(points, light, 0, 0, 500);
  ASSERT_EQ(ranged.rgba.size(), image.rgba.size());
  const std::size_t at = (std::size_t(top + 20) * std::size_t(image.width) + 16 + 330) * 4;
  const Vec3 colour = map.at(275.0 / 500);  // at x = 2.75 m
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(ranged.rgba[at + b], srgbFromLinear(colour[int(b)]), 5e-3);
  }
}

}  // namespace
}  // namespace radiosity
