// The contact stage: welding, merging, cutting at contacts, dropping what is buried. Every scene
// is tried as it is and turned by one radian about a skew axis, where every number is rounded.
#include "mesh/polygons/complex.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include "complex_checks.h"
#include "support/scene_builder.h"

namespace radiosity::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Builds the scene in both positions, checks what holds of all, and then what the test says.
void bothWays(const Scene& scene, const std::function<void(const Built&)>& expect,
              bool exact = true) {
  for (const bool turn : {false, true}) {
    SCOPED_TRACE(turn ? "turned" : "as it is");
    const Built built = build(turn ? turned(scene) : scene);
    checkAll(built, exact);
    expect(built);
  }
}

/// Relative 1e-12, as areas are asked to be.
void expectArea(double value, double expected) {
  EXPECT_NEAR(value, expected, 1e-12 * std::abs(expected));
}

bool hasNote(const Built& built, const std::string& text) {
  return std::any_of(built.report.notes.begin(), built.report.notes.end(),
                     [&](const Note& n) { return n.text.find(text) != std::string::npos; });
}

TEST(Contact, BlockTurnedOnFloorBuriesBothWhereTheyTouch) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index block = b.surface("block");
  b.level(floor, 0, 0, 10, 8, 0);
  b.prism(block, SceneBuilder::turnedRectangle({4, 4}, 2, 3, 17 * kDegree), 0, 2);
  bothWays(b.scene(), [&](const Built& built) {
    // The floor is cut along the block's four bottom edges; floor and bottom are gone there.
    EXPECT_EQ(built.report.cuts, 4u);
    EXPECT_EQ(onlyPolygon(built, floor).loops.size(), 2u);
    EXPECT_TRUE(onlyPolygon(built, floor).inner_edges.empty());
    EXPECT_EQ(polygonsOf(built, block), 5u);
    expectArea(built.report.surfaces[floor].buried, 6);
    expectArea(built.report.surfaces[block].buried, 6);
    EXPECT_EQ(built.complex.vertices.size(), 12u);
  });
}

TEST(Contact, FloorInTilesGivesTheSameAsOneFloor) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index block = b.surface("block");
  for (int x = 0; x < 10; ++x) {
    for (int y = 0; y < 8; ++y) b.level(floor, x, y, x + 1, y + 1, 0);
  }
  b.prism(block, SceneBuilder::turnedRectangle({4, 4}, 2, 3, 17 * kDegree), 0, 2);
  bothWays(b.scene(), [&](const Built& built) {
    // Tiles and the crossings of their seams with the contact lines leave no trace.
    EXPECT_EQ(built.report.cuts, 4u);
    EXPECT_EQ(built.complex.vertices.size(), 12u);
    EXPECT_EQ(onlyPolygon(built, floor).loops[0].size(), 4u);
    EXPECT_EQ(onlyPolygon(built, floor).faces.size(), 80u);
    expectArea(built.report.surfaces[floor].buried, 6);
    expectArea(built.report.surfaces[block].buried, 6);
  });
}

TEST(Contact, BlockThroughWallBuriesTheWallInIt) {
  SceneBuilder b;
  const Index wall = b.surface("wall");
  const Index block = b.surface("block");
  b.face(wall, {{5, 0, 0}, {5, 6, 0}, {5, 6, 4}, {5, 0, 4}});
  b.box(block, {4, 2, 1}, {7, 3, 2});
  bothWays(b.scene(), [&](const Built& built) {
    // Four segments: each cuts the wall, and a long side of the block, which stays one polygon.
    EXPECT_EQ(built.report.cuts, 4u);
    EXPECT_EQ(onlyPolygon(built, wall).loops.size(), 2u);
    EXPECT_EQ(polygonsOf(built, block), 6u);
    expectArea(built.report.surfaces[wall].buried, 1);
    EXPECT_EQ(built.report.surfaces[block].buried, 0);
    std::size_t inner = 0;
    for (const CoarsePolygon& p : built.complex.polygons) inner += p.inner_edges.size();
    EXPECT_EQ(inner, 4u);
  });
}

TEST(Contact, TwoBlocksShareAPartOfAFace) {
  SceneBuilder b;
  const Index left = b.surface("left");
  const Index right = b.surface("right");
  b.box(left, {0, 0, 0}, {2, 2, 2});
  b.box(right, {2, 1, 1}, {4, 3, 3});
  bothWays(b.scene(), [&](const Built& built) {
    // The square in contact: two of its sides are edges of the one block that cut the other's
    // face, two the other way round.
    EXPECT_EQ(built.report.cuts, 4u);
    EXPECT_EQ(polygonsOf(built, left), 6u);
    EXPECT_EQ(polygonsOf(built, right), 6u);
    expectArea(built.report.surfaces[left].buried, 1);
    expectArea(built.report.surfaces[right].buried, 1);
  });
}

TEST(Contact, StackedBlocksBuryBothWhereTheyTouch) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index low = b.surface("low");
  const Index high = b.surface("high");
  b.level(floor, -5, -5, 5, 5, 0);
  b.prism(low, SceneBuilder::turnedRectangle({0, 0}, 4, 4, 30 * kDegree), 0, 1);
  b.prism(high, SceneBuilder::turnedRectangle({0, 0}, 2, 1, 17 * kDegree), 1, 3);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 8u);  // four in the floor, four in the lower block's top
    EXPECT_EQ(polygonsOf(built, floor), 1u);
    EXPECT_EQ(polygonsOf(built, low), 5u);
    EXPECT_EQ(polygonsOf(built, high), 5u);
    expectArea(built.report.surfaces[floor].buried, 16);
    expectArea(built.report.surfaces[low].buried, 18);
    expectArea(built.report.surfaces[high].buried, 2);
  });
}

TEST(Contact, StackedBlocksOfOneFootprintNeedNoCut) {
  SceneBuilder b;
  const Index low = b.surface("low");
  const Index high = b.surface("high");
  b.box(low, {0, 0, 0}, {2, 3, 1});
  b.box(high, {0, 0, 1}, {2, 3, 2});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 0u);  // nothing is divided: whole faces are in contact
    EXPECT_EQ(polygonsOf(built, low), 5u);
    EXPECT_EQ(polygonsOf(built, high), 5u);
    EXPECT_EQ(built.report.nonmanifold_edges, 4u);  // the common rim has four faces
    expectArea(built.report.surfaces[low].buried, 6);
    expectArea(built.report.surfaces[high].buried, 6);
  });
}

TEST(Contact, ACupboardAsHighAsTheRoomStaysASolid) {
  // It shares whole edges with the room: four faces each. The room must not make it open.
  SceneBuilder b;
  const Index room = b.surface("room");
  const Index cupboard = b.surface("cupboard");
  b.box(room, {0, 0, 0}, {5, 4, 3}, false);
  b.box(cupboard, {0, 0, 0}, {1, 1, 3});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, cupboard), 2u);
    EXPECT_EQ(polygonsOf(built, room), 6u);
    expectArea(built.report.surfaces[room].buried, 1 + 1 + 3 + 3);
    expectArea(built.report.surfaces[cupboard].buried, 1 + 1 + 3 + 3);
    EXPECT_EQ(built.report.cuts, 6u);  // two in the floor and the ceiling each, one a wall
  });
}

TEST(Contact, AGapStaysAGap) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index block = b.surface("block");
  const double diagonal = std::sqrt(10.0 * 10 + 8 * 8 + 2 * 2);
  b.level(floor, 0, 0, 10, 8, 0);
  b.prism(block, SceneBuilder::turnedRectangle({4, 4}, 2, 3, 17 * kDegree), 1e-5 * diagonal, 2);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 0u);
    EXPECT_EQ(onlyPolygon(built, floor).loops.size(), 1u);
    EXPECT_EQ(polygonsOf(built, block), 6u);
    EXPECT_EQ(built.report.surfaces[floor].buried, 0);
    EXPECT_EQ(built.report.surfaces[block].buried, 0);
  });
}

TEST(Contact, CylinderOf48SidesOnFloorCutsItsOutline) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index cylinder = b.surface("cylinder");
  b.level(floor, -4, -4, 4, 4, 0);
  b.prism(cylinder, SceneBuilder::regularPolygon({0.3, 0.1}, 1, 48), 0, 2);
  const double base = 24 * std::sin(2 * std::numbers::pi / 48);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 48u);
    EXPECT_EQ(polygonsOf(built, cylinder), 49u);
    EXPECT_EQ(onlyPolygon(built, floor).loops[1].size(), 48u);
    expectArea(built.report.surfaces[floor].buried, base);
    expectArea(built.report.surfaces[cylinder].buried, base);
  });
}

TEST(Contact, TiltedWallStandsOnFloorAndMakesAnInnerEdge) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index wall = b.surface("wall");
  b.level(floor, 0, 0, 4, 4, 0);
  b.face(wall, {{1, 1, 0}, {3, 2, 0}, {3, 2.5, 2}, {1, 1.5, 2}});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 1u);
    EXPECT_EQ(onlyPolygon(built, floor).inner_edges.size(), 1u);
    EXPECT_EQ(onlyPolygon(built, floor).loops.size(), 1u);
    EXPECT_EQ(polygonsOf(built, wall), 1u);
  });
}

TEST(Contact, SheetsThatCrossShareAnInnerEdge) {
  SceneBuilder b;
  const Index level = b.surface("level");
  const Index upright = b.surface("upright");
  b.level(level, 0, 0, 4, 4, 0);
  b.face(upright, {{1, 2, -1}, {3, 2.5, -1}, {3, 2.5, 1}, {1, 2, 1}});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 1u);  // one segment that cuts both
    EXPECT_EQ(onlyPolygon(built, level).inner_edges.size(), 1u);
    EXPECT_EQ(onlyPolygon(built, upright).inner_edges, onlyPolygon(built, level).inner_edges);
  });
}

TEST(Contact, InterpenetratingSolidsLoseWhatIsInTheOther) {
  SceneBuilder b;
  const Index first = b.surface("first");
  const Index second = b.surface("second");
  b.box(first, {0, 0, 0}, {2, 2, 2});
  b.box(second, {1, 1, 1}, {3, 3, 3});
  bothWays(b.scene(), [&](const Built& built) {
    // The surfaces meet in a hexagon in space; a corner of each is inside the other.
    EXPECT_EQ(built.report.cuts, 6u);
    EXPECT_EQ(polygonsOf(built, first), 6u);
    EXPECT_EQ(polygonsOf(built, second), 6u);
    expectArea(built.report.surfaces[first].buried, 3);
    expectArea(built.report.surfaces[second].buried, 3);
  });
}

/// Boxes on the grid of whole numbers, as they come: overlapping, touching, flush, one in another,
/// sharing edges. Truth: what can be seen of solids is the surface of their union, which is a
/// matter of counting unit cubes.
TEST(Contact, RandomBoxesShowTheSurfaceOfTheirUnion) {
  constexpr int kSize = 7;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    SceneBuilder b;
    std::array<std::array<std::array<bool, kSize + 2>, kSize + 2>, kSize + 2> filled{};
    for (int k = 0; k < 8; ++k) {
      std::array<int, 3> low{};
      std::array<int, 3> high{};
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = int(random() % (kSize - 1));
        high[axis] = low[axis] + 1 + int(random() % 3);
        high[axis] = std::min(high[axis], kSize);
      }
      b.box(b.surface("box" + std::to_string(k)), Vec3(low[0], low[1], low[2]),
            Vec3(high[0], high[1], high[2]));
      for (int x = low[0]; x < high[0]; ++x) {
        for (int y = low[1]; y < high[1]; ++y) {
          for (int z = low[2]; z < high[2]; ++z) filled[x + 1][y + 1][z + 1] = true;
        }
      }
    }
    double surface = 0;
    for (int x = 0; x <= kSize; ++x) {
      for (int y = 0; y <= kSize; ++y) {
        for (int z = 0; z <= kSize; ++z) {
          surface += filled[x][y][z] != filled[x + 1][y][z] ? 1 : 0;
          surface += filled[x][y][z] != filled[x][y + 1][z] ? 1 : 0;
          surface += filled[x][y][z] != filled[x][y][z + 1] ? 1 : 0;
        }
      }
    }
    bothWays(b.scene(), [&](const Built& built) {
      double kept = 0;
      for (const CoarsePolygon& p : built.complex.polygons) {
        kept += glm::length(vectorArea(built.complex, p));
      }
      expectArea(kept, surface);
    });
  }
}

/// Files with six digits: a house reaches into its roof by a few millionths here and misses it by
/// as much there, which is about the coincidence (2.3e-6 m), so that no cut parts what is in the
/// roof from the rest of the house.
TEST(Contact, SolidsInContactButForRoundingLoseTheContactAlone) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> off(-5e-6, 5e-6);
    SceneBuilder b;
    const Index house = b.surface("house");
    const Index roof = b.surface("roof");
    b.box(house, {0, 0, 0}, {14, 14, 7});
    b.box(roof, {-0.5, -0.5, 7}, {14.5, 14.5, 9});
    Scene scene = b.scene();
    for (Vec3& v : scene.vertices) v += Vec3(off(random), off(random), off(random));
    for (const bool turn : {false, true}) {
      const Built built = build(turn ? turned(scene) : scene);
      const SurfaceAreas& of_house = built.report.surfaces[house];
      const SurfaceAreas& of_roof = built.report.surfaces[roof];
      // Walls and bottom; the roof without what stands on the house. Where the two are more than
      // the coincidence apart they see each other. A strip as wide as the noise along the
      // contact's 56 m is less than 1e-3 m^2.
      EXPECT_GT(of_house.given - of_house.buried - of_house.overlapped, 4 * 14 * 7 + 196 - 1e-3);
      EXPECT_GT(of_roof.given - of_roof.buried - of_roof.overlapped, 2 * 225 + 4 * 30 - 196 - 1e-3);
    }
  }
}

TEST(Contact, ASolidInsideASolidIsDroppedAndReported) {
  SceneBuilder b;
  const Index outer = b.surface("outer");
  const Index inner = b.surface("inner");
  b.box(outer, {0, 0, 0}, {4, 4, 4});
  b.box(inner, {1, 1, 1}, {2, 2, 2});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, outer), 6u);
    EXPECT_EQ(polygonsOf(built, inner), 0u);
    expectArea(built.report.surfaces[inner].buried, 6);
    EXPECT_TRUE(hasNote(built, "inner/inner: lies wholly inside"));
  });
}

/// As files from modellers have them that export some faces of a body once for each side: what is
/// turned inward sees nothing, and what it lies on is seen as if it were not there.
TEST(Contact, FacesOfASolidModelledOnBothSidesKeepTheirOutside) {
  const std::vector<Vec3> front{{0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}};
  const std::vector<Vec3> left{{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}};
  const std::vector<Vec3> bottom{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const std::vector<std::vector<Vec3>> inward{front, left, bottom};
  for (const std::size_t doubled : {1u, 2u, 3u}) {
    for (const bool one_surface : {true, false}) {
      SceneBuilder b;
      const Index body = b.surface("body");
      const Index lining = one_surface ? body : b.surface("lining");
      b.box(body, {0, 0, 0}, {2, 2, 2});
      for (std::size_t k = 0; k < doubled; ++k) b.face(lining, inward[k]);
      bothWays(b.scene(), [&](const Built& built) {
        EXPECT_EQ(built.complex.polygons.size(), 6u) << doubled << one_surface;
        EXPECT_EQ(polygonsOf(built, body), 6u);
        expectArea(built.report.surfaces[lining].buried, 4.0 * double(doubled));
      });
    }
  }
}

/// A lamp head of sheets that are modelled on both sides, with a sheet across it: both chambers are
/// seen from inside, and all of it from outside.
TEST(Contact, TwoChambersOfSheetsModelledOnBothSidesAreSeenFromInside) {
  SceneBuilder b;
  const Index head = b.surface("head");
  for (const double low : {0.0, 1.0}) b.box(head, {low, 0, 0}, {low + 1, 1, 1});
  b.box(head, {0, 0, 0}, {2, 1, 1}, false);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.surfaces[head].buried, 0);
    EXPECT_EQ(built.report.surfaces[head].overlapped, 0);
  });
}

/// A chamber within walls as thick as `wall`, or as thin as two sheets back to back, with a heater
/// in it that stands on its floor: all of the chamber is seen but where the heater stands.
TEST(Contact, AChamberInASolidIsSeenFromInside) {
  for (const double wall : {0.5, 0.0}) {
    SceneBuilder b;
    const Index shell = b.surface("shell");
    const Index chamber = b.surface("chamber");
    const Index heater = b.surface("heater");
    b.box(shell, {0, 0, 0}, {4, 4, 4});
    b.box(chamber, {wall, wall, wall}, {4 - wall, 4 - wall, 4 - wall}, false);
    b.box(heater, {1, 1, wall}, {2, 2, 2});
    bothWays(b.scene(), [&](const Built& built) {
      // Of thin walls, the part that is back to back with nothing, under the heater, is one more.
      EXPECT_EQ(polygonsOf(built, shell), wall > 0 ? 6u : 7u);
      EXPECT_EQ(polygonsOf(built, chamber), 6u);
      EXPECT_EQ(polygonsOf(built, heater), 5u);
      EXPECT_EQ(built.report.surfaces[shell].buried, 0);
      expectArea(built.report.surfaces[chamber].buried, 1);
      expectArea(built.report.surfaces[heater].buried, 1);
    });
  }
}

/// Of one surface, as CAD exports it; and a room's furniture is no chamber.
TEST(Contact, AnInnerShellTurnedInwardMakesASolidHollow) {
  SceneBuilder hollow;
  const Index oven = hollow.surface("oven");
  hollow.box(oven, {0, 0, 0}, {4, 4, 4});
  hollow.box(oven, {1, 1, 1}, {3, 3, 3}, false);
  bothWays(hollow.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, oven), 12u);
    EXPECT_EQ(built.report.surfaces[oven].buried, 0);
  });
  SceneBuilder room;
  const Index walls = room.surface("walls");
  const Index block = room.surface("block");
  const Index within = room.surface("within");
  room.box(walls, {0, 0, 0}, {9, 9, 9}, false);
  room.box(block, {2, 2, 2}, {6, 6, 6});
  room.box(within, {3, 3, 3}, {4, 4, 4});
  bothWays(room.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, walls), 6u);
    EXPECT_EQ(polygonsOf(built, block), 6u);
    EXPECT_EQ(polygonsOf(built, within), 0u);
  });
}

TEST(Contact, OpenContainerOnFloorKeepsBothAndSaysSo) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index box = b.surface("container");
  b.level(floor, 0, 0, 6, 6, 0);
  SceneBuilder whole;
  whole.surface("floor");
  whole.surface("container");
  whole.box(box, {2, 2, 0}, {4, 4, 1});
  for (std::size_t f = 0; f + 1 < whole.scene().faceCount(); ++f) {  // all but the top
    std::vector<Vec3> corners;
    for (const Index c : whole.scene().face(f)) corners.push_back(whole.scene().vertices[c]);
    b.face(box, corners);
  }
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 4u);
    EXPECT_EQ(polygonsOf(built, box), 5u);
    EXPECT_EQ(polygonsOf(built, floor), 2u);  // the part back to back with the bottom, the rest
    EXPECT_EQ(built.report.surfaces[floor].buried, 0);
    EXPECT_TRUE(hasNote(built, "back to back"));
  });
}

/// Appends the prism without its bottom.
void hood(SceneBuilder& b, Index surface, const std::vector<Vec2>& base, double z0, double z1) {
  SceneBuilder whole;
  whole.surface("hood");
  whole.prism(0, base, z0, z1);
  const Scene& scene = whole.scene();
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    if (f == base.size()) continue;  // the bottom
    std::vector<Vec3> corners;
    for (const Index c : scene.face(f)) corners.push_back(scene.vertices[c]);
    b.face(surface, corners);
  }
}

/// A floor of 10 x 8 m and a block of 2 x 3 m on it, turned, without a bottom.
struct HoodOnFloor {
  SceneBuilder b;
  Index floor = b.surface("floor");
  Index block = b.surface("block");
  Index lamp = b.surface("lamp", 0, 5);
  explicit HoodOnFloor(double z0 = 0) {
    b.level(floor, 0, 0, 10, 8, 0);
    hood(b, block, SceneBuilder::turnedRectangle({4, 4}, 2, 3, 17 * kDegree), z0, 2);
  }
};

TEST(Hollows, TheFloorUnderABlockWithoutABottomIsBuried) {
  for (const double z0 : {0.0, -0.5}) {  // stands on the floor, reaches through it
    HoodOnFloor scene(z0);
    bothWays(scene.b.scene(), [&](const Built& built) {
      EXPECT_EQ(onlyPolygon(built, scene.floor).loops.size(), 2u);
      expectArea(built.report.surfaces[scene.floor].buried, 6);
      EXPECT_EQ(built.report.surfaces[scene.block].buried, 0);
      EXPECT_TRUE(hasNote(built, "6 m^2 were dropped in dark hollows"));
    });
  }
}

TEST(Hollows, ALightInsideKeepsTheFloor) {
  HoodOnFloor scene;
  scene.b.level(scene.lamp, 3.9, 3.9, 4.1, 4.1, 1, false);  // free, in the block
  bothWays(scene.b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.surfaces[scene.floor].buried, 0);
    EXPECT_EQ(onlyPolygon(built, scene.floor).loops.size(), 1u);
  });
  HoodOnFloor beside;
  beside.b.level(beside.lamp, 8, 3.9, 8.2, 4.1, 1, false);
  bothWays(beside.b.scene(),
           [&](const Built& built) { expectArea(built.report.surfaces[beside.floor].buried, 6); });
}

TEST(Hollows, AGapOfAMillimetreKeepsTheFloor) {
  HoodOnFloor scene(1e-3);
  bothWays(scene.b.scene(),
           [&](const Built& built) { EXPECT_EQ(built.report.surfaces[scene.floor].buried, 0); });
}

TEST(Hollows, ATwoSidedBlockKeepsItsInsideAndTheFloor) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index block = b.surface("block", 0.5, 0, true);
  b.level(floor, 0, 0, 10, 8, 0);
  hood(b, block, SceneBuilder::turnedRectangle({4, 4}, 2, 3, 17 * kDegree), 0, 2);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.surfaces[floor].buried, 0);
    EXPECT_EQ(onlyPolygon(built, floor).loops.size(), 1u);
  });
}

TEST(Hollows, HillsUnderTwoBlocksThatShareAWallAreBuried) {
  SceneBuilder b;
  const Index ground = b.surface("ground");
  const Index blocks = b.surface("blocks");
  // Two slopes that meet in a ridge along y, and blocks over the ridge.
  b.face(ground, {{0, 0, 0}, {4, 0, 1}, {4, 8, 1}, {0, 8, 0}});
  b.face(ground, {{4, 0, 1}, {8, 0, 0}, {8, 8, 0}, {4, 8, 1}});
  hood(b, blocks, {{3, 2}, {5, 2}, {5, 4}, {3, 4}}, -1, 3);
  hood(b, blocks, {{3, 4}, {5, 4}, {5, 6}, {3, 6}}, -1, 3);
  const double under = 8 * std::sqrt(1 + 1. / 16);
  bothWays(b.scene(),
           [&](const Built& built) { expectArea(built.report.surfaces[ground].buried, under); });
}

TEST(Hollows, ADarkRoomOfWhichHalfIsSeenFromInsideIsKept) {
  SceneBuilder b;
  const Index room = b.surface("room");
  SceneBuilder whole;
  whole.surface("room");
  whole.box(0, {0, 0, 0}, {4, 4, 4}, false);
  const Scene& scene = whole.scene();
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    std::vector<Vec3> corners;
    for (const Index c : scene.face(f)) corners.push_back(scene.vertices[c]);
    if (f % 2 == 0) std::reverse(corners.begin(), corners.end());
    b.face(room, corners);
  }
  bothWays(b.scene(),
           [&](const Built& built) { EXPECT_EQ(built.report.surfaces[room].buried, 0); });
}

TEST(Overlap, LampOnUncutCeiling) {
  SceneBuilder b;
  const Index ceiling = b.surface("ceiling");
  const Index lamp = b.surface("lamp", 0, 10);
  b.level(ceiling, 0, 0, 5, 5, 3, false);
  b.level(lamp, 2, 2, 3, 4, 3, false);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.cuts, 4u);  // the lamp's outline in the ceiling
    EXPECT_EQ(onlyPolygon(built, ceiling).loops.size(), 2u);
    EXPECT_EQ(polygonsOf(built, lamp), 1u);
    expectArea(built.report.surfaces[ceiling].overlapped, 2);
    EXPECT_EQ(built.report.surfaces[lamp].overlapped, 0);
    EXPECT_TRUE(hasNote(built, "lamp/lamp was kept"));
  });
}

TEST(Overlap, EmitterThenSmallerThenName) {
  SceneBuilder b;
  const Index large_lamp = b.surface("lamp", 0, 1);
  const Index small = b.surface("small");
  const Index twin_b = b.surface("b");
  const Index twin_a = b.surface("a");
  b.level(large_lamp, 0, 0, 4, 4, 0);
  b.level(small, 3, 3, 5, 5, 0);     // 1 m^2 under the lamp
  b.level(twin_b, 10, 0, 12, 2, 0);  // 2 m^2 under its twin of equal size
  b.level(twin_a, 11, 0, 13, 2, 0);
  bothWays(b.scene(), [&](const Built& built) {
    expectArea(built.report.surfaces[small].overlapped, 1);
    EXPECT_EQ(built.report.surfaces[large_lamp].overlapped, 0);
    expectArea(built.report.surfaces[twin_b].overlapped, 2);
    EXPECT_EQ(built.report.surfaces[twin_a].overlapped, 0);
  });
}

TEST(Repair, TJunctionInTheFileSplitsTheLongEdge) {
  SceneBuilder b;
  const Index long_side = b.surface("long");
  const Index first = b.surface("first");
  const Index second = b.surface("second");
  b.level(long_side, 0, 0, 1, 2, 0);
  b.level(first, 1, 0, 2, 1, 0);
  b.level(second, 1, 1, 2, 2, 0);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.split_edges, 1u);
    EXPECT_EQ(built.report.cuts, 0u);
    EXPECT_EQ(onlyPolygon(built, long_side).loops[0].size(), 5u);
  });
}

TEST(Repair, TJunctionInsideOneSurfaceIsGone) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  b.level(floor, 0, 0, 1, 2, 0);
  b.level(floor, 1, 0, 2, 1, 0);
  b.level(floor, 1, 1, 2, 2, 0);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(onlyPolygon(built, floor).loops[0].size(), 4u);
    EXPECT_EQ(built.complex.vertices.size(), 4u);
  });
}

TEST(Repair, ATJunctionInItsSkinDoesNotOpenASolid) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index block = b.surface("block");
  const Index half = b.surface("half");
  b.level(floor, -2, -2, 4, 4, 0);
  SceneBuilder whole;
  whole.surface("floor");
  whole.surface("block");
  whole.box(block, {0, 0, 0}, {2, 2, 2});
  for (std::size_t f = 1; f < whole.scene().faceCount(); ++f) {  // all but the side y = 0
    std::vector<Vec3> corners;
    for (const Index c : whole.scene().face(f)) corners.push_back(whole.scene().vertices[c]);
    b.face(block, corners);
  }
  b.face(block, {{0, 0, 0}, {1, 0, 0}, {1, 0, 2}, {0, 0, 2}});
  b.face(half, {{1, 0, 0}, {2, 0, 0}, {2, 0, 2}, {1, 0, 2}});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.split_edges, 2u);  // of the bottom and of the top
    expectArea(built.report.surfaces[floor].buried, 4);
    expectArea(built.report.surfaces[block].buried, 4);
    EXPECT_EQ(polygonsOf(built, block), 5u);
  });
}

TEST(Repair, ASelfCrossingPolygonIsReported) {
  SceneBuilder b;
  const Index bow = b.surface("bow");
  // Crosses itself at (4/3, 4/3): triangles of 8/3 and, turned over, 2/3 m^2.
  b.face(bow, {{0, 0, 0}, {4, 0, 0}, {0, 2, 0}, {2, 2, 0}});
  b.face(bow, {{5, 0, 0}, {6, 0, 0}, {6, 3, 0}, {5, 3, 0}});
  const Built built = build(b.scene());
  checkShape(built.complex);
  checkConforming(built.complex);
  EXPECT_EQ(polygonsOf(built, bow), 3u);
  EXPECT_TRUE(hasNote(built, "crosses itself"));
  expectArea(built.report.surfaces[bow].given, 3 + 10.0 / 3);
}

TEST(Repair, NoWeldAtAllStillFindsContacts) {
  // What is left of coincidence is the rounding of doubles.
  SceneBuilder b;
  const Index floor = b.surface("floor");
  b.level(floor, 0, 0, 10, 8, 0);
  b.prism(b.surface("block"), SceneBuilder::turnedRectangle({4, 4}, 2, 3, 17 * kDegree), 0, 2);
  MeshOptions exact;
  exact.weld = 0;
  for (const Scene& scene : {b.scene(), turned(b.scene())}) {
    const Built built = build(scene, exact);
    EXPECT_EQ(built.report.cuts, 4u);
    expectArea(built.report.surfaces[floor].buried, 6);
  }
}

TEST(Repair, DuplicatesAndSliversAreCounted) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  b.level(floor, 0, 0, 4, 4, 0);
  b.level(floor, 0, 0, 4, 4, 0);
  b.face(floor, {{0, 0, 1}, {4, 0, 1}, {2, 1e-9, 1}});  // a width far below coincidence
  b.face(floor, {{0, 0, 2}, {1, 0, 2}, {1, 0, 2}});     // two corners in one place
  bothWays(
      b.scene(),
      [&](const Built& built) {
        EXPECT_EQ(built.report.duplicate_faces, 1u);
        EXPECT_EQ(built.report.degenerate_faces, 2u);
        expectArea(built.report.surfaces[floor].overlapped, 16);
        // 2e-9 m^2 out of coordinates that are rounded at 1e-16
        EXPECT_NEAR(built.report.surfaces[floor].degenerate, 2e-9, 1e-14);
        EXPECT_EQ(polygonsOf(built, floor), 1u);
      },
      false);
}

TEST(Repair, NonPlanarQuadBecomesTriangles) {
  SceneBuilder b;
  const Index wall = b.surface("wall");
  b.face(wall, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0.03}, {0, 2, 0}});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.nonplanar_faces, 1u);
    EXPECT_EQ(polygonsOf(built, wall), 2u);
    // Which diagonal is taken is open: the fourth corner is 0.03 above the plane of the others,
    // or a little less above that of the triangle across the other diagonal.
    EXPECT_NEAR(built.report.largest_deviation, 0.03, 1e-3);
  });
}

/// The second sheet begins with every corner in turn: both are cut into the same triangles, so
/// none hides a part of the other.
TEST(Repair, ANonPlanarPolygonOnBothSidesKeepsBoth) {
  std::vector<Vec3> rim;
  for (int k = 0; k < 12; ++k) {
    const double angle = 30 * kDegree * k;
    rim.emplace_back(std::cos(angle), std::sin(angle), 0.2 * std::cos(2 * angle + 0.3 * k));
  }
  for (std::size_t first = 0; first < rim.size(); ++first) {
    std::vector<Vec3> reversed(rim.rbegin(), rim.rend());
    std::rotate(reversed.begin(), reversed.begin() + std::ptrdiff_t(first), reversed.end());
    SceneBuilder b;
    const Index front = b.surface("front");
    const Index back = b.surface("back");
    b.face(front, rim);
    b.face(back, reversed);
    bothWays(b.scene(), [&](const Built& built) {
      EXPECT_EQ(polygonsOf(built, front), 10u) << first;
      EXPECT_EQ(polygonsOf(built, back), 10u) << first;
      for (const CoarsePolygon& p : built.complex.polygons) EXPECT_NE(p.opposite, kNone) << first;
    });
  }
}

TEST(Repair, EachSurfaceIsToldHowFarItsOwnPolygonsAreOff) {
  SceneBuilder b;
  b.face(b.surface("floor"), {{0, 0, 0}, {4, 0, 0}, {4, 4, 0.02}, {0, 4, 0}});
  b.face(b.surface("tent"), {{10, 0, 0}, {14, 0, 0}, {14, 4, 2}, {10, 4, 0}});
  bothWays(b.scene(), [&](const Built& built) {
    // The fourth corner is so far above the plane of the others, or a little less, by the diagonal.
    EXPECT_TRUE(hasNote(built, "floor/floor: 1 polygon was not planar (up to 0.02 m off)"));
    EXPECT_GT(built.report.largest_deviation, 1);
  });
}

TEST(Repair, SeparateVerticesAreWelded) {
  SceneBuilder b;
  const Index box = b.surface("box");
  b.box(box, {0, 0, 0}, {1, 2, 3});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.welded_vertices, 16u);  // 24 corners, 8 places
    EXPECT_EQ(built.complex.vertices.size(), 8u);
    EXPECT_EQ(polygonsOf(built, box), 6u);
    EXPECT_EQ(built.report.nonmanifold_edges, 0u);
  });
}

TEST(Repair, EmptySceneIsAnError) {
  SceneBuilder nothing;
  EXPECT_THROW(build(nothing.scene()), InputError);
  SceneBuilder point;
  point.face(point.surface("point"), {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}});
  EXPECT_THROW(build(point.scene()), InputError);
  SceneBuilder line;
  line.face(line.surface("line"), {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_THROW(build(line.scene()), InputError);
  SceneBuilder broken;
  broken.level(broken.surface("floor"), 0, 0, 1, 1, std::nan(""));
  EXPECT_THROW(build(broken.scene()), InputError);
}

TEST(Sheets, PlateWithoutThicknessSurvives) {
  SceneBuilder b;
  const Index plate = b.surface("plate");
  b.box(plate, {0, 0, 1}, {2, 1, 1});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, plate), 2u);
    EXPECT_EQ(built.complex.polygons[0].opposite, 1u);
    EXPECT_EQ(built.report.surfaces[plate].buried, 0);
    EXPECT_EQ(built.report.degenerate_faces, 4u);
  });
}

TEST(Sheets, ThreeWallsAtOneEdgeShareIt) {
  SceneBuilder b;
  const Index wall = b.surface("wall");
  for (int k = 0; k < 3; ++k) {
    const double a = 2 * std::numbers::pi * k / 3;
    b.face(wall,
           {{0, 0, 0}, {std::cos(a), std::sin(a), 0}, {std::cos(a), std::sin(a), 1}, {0, 0, 1}});
  }
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(built.report.nonmanifold_edges, 1u);
    EXPECT_EQ(polygonsOf(built, wall), 3u);
    EXPECT_EQ(built.complex.vertices.size(), 8u);
  });
}

using Triangle = std::array<Vec3, 3>;

double signedVolume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

bool pierces(const Vec3& a, const Vec3& b, const Triangle& t) {
  if ((signedVolume(t[0], t[1], t[2], a) > 0) == (signedVolume(t[0], t[1], t[2], b) > 0)) {
    return false;
  }
  const bool s = signedVolume(a, b, t[0], t[1]) > 0;
  return (signedVolume(a, b, t[1], t[2]) > 0) == s && (signedVolume(a, b, t[2], t[0]) > 0) == s;
}

/// In general position triangles cross along a segment just if an edge of one pierces the other.
bool cross(const Triangle& a, const Triangle& b) {
  for (int k = 0; k < 3; ++k) {
    if (pierces(a[k], a[(k + 1) % 3], b) || pierces(b[k], b[(k + 1) % 3], a)) return true;
  }
  return false;
}

/// Whether three triangles have a point in common: the one where their planes meet.
bool meet(const Triangle& a, const Triangle& b, const Triangle& c) {
  const auto normal = [](const Triangle& t) { return glm::cross(t[1] - t[0], t[2] - t[0]); };
  const Vec3 na = normal(a);
  const Vec3 nb = normal(b);
  const Vec3 nc = normal(c);
  const Vec3 at =
      (glm::cross(nb, nc) * glm::dot(na, a[0]) + glm::cross(nc, na) * glm::dot(nb, b[0]) +
       glm::cross(na, nb) * glm::dot(nc, c[0])) /
      glm::dot(na, glm::cross(nb, nc));
  const auto holds = [&](const Triangle& t) {
    for (int k = 0; k < 3; ++k) {
      if (glm::dot(normal(t), glm::cross(t[(k + 1) % 3] - t[k], at - t[k])) < 0) return false;
    }
    return true;
  };
  return holds(a) && holds(b) && holds(c);
}

TEST(Sheets, SoupOfTrianglesThatCrossIsCutAtEachCrossing) {
  SceneBuilder b;
  const Index soup = b.surface("soup");
  std::mt19937 random(7);
  const auto coordinate = [&] { return double(random() % 10000) / 10000.0; };
  std::vector<Triangle> triangles;
  for (int k = 0; k < 40; ++k) {
    const Vec3 o(coordinate(), coordinate(), coordinate());
    Triangle t;
    for (Vec3& p : t) {
      const double x = coordinate();
      const double y = coordinate();
      p = o + 1.5 * Vec3(x - 0.5, y - 0.5, coordinate() - 0.5);
    }
    triangles.push_back(t);
    b.face(soup, {t[0], t[1], t[2]});
  }
  // Every two that cross do so along a segment; every three that meet divide three segments.
  std::size_t segments = 0;
  std::size_t triples = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!cross(triangles[i], triangles[j])) continue;
      ++segments;
      for (std::size_t k = 0; k < j; ++k) {
        if (meet(triangles[i], triangles[j], triangles[k])) ++triples;
      }
    }
  }
  ASSERT_GT(triples, 5u);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, soup), triangles.size());
    EXPECT_EQ(built.report.cuts, segments + 3 * triples);
    // Three corners each, two ends a segment, and the triple points.
    EXPECT_EQ(built.complex.vertices.size(), 3 * triangles.size() + 2 * segments + triples);
  });
}

TEST(Sheets, AnnulusOfTilesAndAHoleThatTouchesTheRim) {
  SceneBuilder b;
  const Index ring = b.surface("ring");
  const Index notch = b.surface("notch");
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (x != 1 || y != 1) b.level(ring, x, y, x + 1, y + 1, 0);
    }
  }
  // A square less a diamond that touches its border at one point.
  b.face(notch, {{10, 0, 0},
                 {12, 0, 0},
                 {11, 1, 0},
                 {12, 2, 0},
                 {13, 1, 0},
                 {12, 0, 0},
                 {14, 0, 0},
                 {14, 4, 0},
                 {10, 4, 0}});
  bothWays(b.scene(), [&](const Built& built) {
    ASSERT_EQ(onlyPolygon(built, ring).loops.size(), 2u);
    EXPECT_EQ(onlyPolygon(built, ring).loops[0].size(), 4u);
    EXPECT_EQ(onlyPolygon(built, ring).loops[1].size(), 4u);
    // Two loops that share a vertex, which the rim therefore keeps.
    ASSERT_EQ(onlyPolygon(built, notch).loops.size(), 2u);
    EXPECT_EQ(onlyPolygon(built, notch).loops[0].size(), 5u);
    EXPECT_EQ(onlyPolygon(built, notch).loops[1].size(), 4u);
    expectArea(built.report.surfaces[notch].given, 14);
  });
}

TEST(TwoSided, SheetOnFloorLosesItsLowerSide) {
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index rug = b.surface("rug", 0.5, 0, true);
  b.level(floor, 0, 0, 4, 4, 0);
  b.level(rug, 1, 1, 2, 3, 0);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(onlyPolygon(built, floor).loops.size(), 2u);
    EXPECT_FALSE(onlyPolygon(built, rug).back);
    EXPECT_EQ(built.report.hidden_sides, 1u);
    EXPECT_EQ(built.report.cuts, 4u);
    expectArea(built.report.surfaces[floor].overlapped, 2);
  });
}

TEST(TwoSided, PosterOnAWallLeavesTheWallItsOtherSide) {
  SceneBuilder b;
  const Index wall = b.surface("wall", 0.5, 0, true);
  const Index poster = b.surface("poster");
  b.level(wall, 0, 0, 4, 4, 0);
  b.level(poster, 1, 1, 2, 3, 0);
  bothWays(b.scene(), [&](const Built& built) {
    // The wall: a ring with both sides, and what is behind the poster, with the other side only.
    EXPECT_EQ(polygonsOf(built, wall), 2u);
    EXPECT_EQ(polygonsOf(built, poster), 1u);
    EXPECT_EQ(built.report.hidden_sides, 1u);
    EXPECT_EQ(built.report.surfaces[wall].overlapped, 0);
  });
}

TEST(TwoSided, RugAndPosterDoNotMakeARoomASolid) {
  SceneBuilder b;
  const Index room = b.surface("room", 0.5, 0, true);
  const Index rug = b.surface("rug", 0.5, 0, true);
  b.box(room, {0, 0, 0}, {5, 4, 3});
  b.level(rug, 1, 1, 2, 3, 0);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, room), 6u);
    EXPECT_EQ(onlyPolygon(built, rug).back, false);
    EXPECT_EQ(built.report.hidden_sides, 7u);
    expectArea(built.report.surfaces[room].overlapped, 2);
  });
}

TEST(TwoSided, FreeSheetKeepsBothSides) {
  SceneBuilder b;
  const Index sheet = b.surface("sheet", 0.5, 0, true);
  b.level(sheet, 0, 0, 1, 1, 0);
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_TRUE(onlyPolygon(built, sheet).back);
    EXPECT_EQ(built.report.hidden_sides, 0u);
  });
}

TEST(TwoSided, BlockInRoomWhicheverWayTheyAreTurned) {
  for (const bool room_out : {false, true}) {
    for (const bool block_out : {false, true}) {
      SCOPED_TRACE(testing::Message() << room_out << block_out);
      SceneBuilder b;
      const Index room = b.surface("room", 0.5, 0, true);
      const Index block = b.surface("block", 0.5, 0, true);
      b.box(room, {0, 0, 0}, {5, 4, 3}, room_out);
      b.prism(block, SceneBuilder::turnedRectangle({2, 2}, 1, 1.5, 17 * kDegree), 0, 1, block_out);
      bothWays(b.scene(), [&](const Built& built) {
        // Inside the block and outside the room there is nothing to see: one side of each.
        EXPECT_EQ(polygonsOf(built, room), 6u);
        EXPECT_EQ(polygonsOf(built, block), 5u);
        EXPECT_EQ(built.report.hidden_sides, 11u);
        EXPECT_EQ(built.report.cuts, 4u);
        expectArea(built.report.surfaces[room].buried, 1.5);
        expectArea(built.report.surfaces[block].buried, 1.5);
        for (const CoarsePolygon& p : built.complex.polygons) {
          EXPECT_FALSE(p.back);
          const Vec3 middle = p.surface == room ? Vec3(0.0) : [&] {
            Vec3 sum(0.0);
            double count = 0;
            for (const CoarsePolygon& q : built.complex.polygons) {
              if (q.surface != block) continue;
              for (const Index v : q.loops[0]) sum += built.complex.vertices[v], ++count;
            }
            return sum / count;
          }();
          const Vec3 away = built.complex.vertices[p.loops[0][0]] - middle;
          EXPECT_EQ(glm::dot(p.normal, away) > 0, p.surface == block)
              << "the room is seen from inside, the block from outside";
        }
      });
    }
  }
}

TEST(TwoSided, ALoneConvexBoxIsSeenFromInside) {
  SceneBuilder b;
  const Index box = b.surface("box", 0.5, 0, true);
  b.box(box, {0, 0, 0}, {1, 1, 1});
  bothWays(b.scene(), [&](const Built& built) {
    EXPECT_EQ(polygonsOf(built, box), 6u);
    EXPECT_EQ(built.report.hidden_sides, 6u);
    EXPECT_TRUE(hasNote(built, "closed, two-sided and alone, so it is a room"));
    for (const CoarsePolygon& p : built.complex.polygons) {
      EXPECT_LT(glm::dot(p.normal, built.complex.vertices[p.loops[0][0]]), 0);
    }
  });
  const Index body = b.surface("body");
  b.box(body, {2, 0, 0}, {3, 1, 1});
  bothWays(b.scene(), [](const Built& built) { EXPECT_FALSE(hasNote(built, "so it is a room")); });
}

/// A room with a turned block, a lamp, a cylinder: something of everything.
Scene furnished() {
  SceneBuilder b;
  const Index room = b.surface("room");
  const Index block = b.surface("block");
  const Index lamp = b.surface("lamp", 0, 10);
  const Index cylinder = b.surface("cylinder");
  b.box(room, {0, 0, 0}, {5, 4, 3}, false);
  b.prism(block, SceneBuilder::turnedRectangle({2, 2}, 1, 1.5, 17 * kDegree), 0, 1);
  b.prism(cylinder, SceneBuilder::regularPolygon({2, 2}, 0.3, 12), 1, 2);
  b.level(lamp, 1, 1, 2, 2, 3, false);
  return b.scene();
}

TEST(Sameness, ScalingByAPowerOfTwoChangesNoBit) {
  const Built one = build(furnished());
  const Built other = build(scaled(furnished(), 0x1p-12));
  ASSERT_EQ(one.complex.vertices.size(), other.complex.vertices.size());
  for (std::size_t v = 0; v < one.complex.vertices.size(); ++v) {
    EXPECT_EQ(one.complex.vertices[v] * 0x1p-12, other.complex.vertices[v]);
  }
  ASSERT_EQ(one.complex.polygons.size(), other.complex.polygons.size());
  for (std::size_t p = 0; p < one.complex.polygons.size(); ++p) {
    EXPECT_EQ(one.complex.polygons[p].loops, other.complex.polygons[p].loops);
    EXPECT_EQ(one.complex.polygons[p].inner_edges, other.complex.polygons[p].inner_edges);
  }
}

TEST(Sameness, CountsSurviveAnyScaleAndAFarOrigin) {
  const Built one = build(furnished());
  checkAll(one);
  for (const Scene& scene : {scaled(furnished(), 1e-6), scaled(furnished(), 1e6),
                             moved(furnished(), Vec3(7e6, -3e6, 5e6)),
                             moved(turned(furnished()), Vec3(7e6, -3e6, 5e6))}) {
    const Built other = build(scene);
    checkAll(other, false);  // far away coordinates are rounded at 1e-9 m, which areas show
    EXPECT_EQ(one.complex.polygons.size(), other.complex.polygons.size());
    EXPECT_EQ(one.complex.vertices.size(), other.complex.vertices.size());
    EXPECT_EQ(one.report.cuts, other.report.cuts);
  }
}

TEST(Sameness, TheOrderOfFacesDoesNotMatter) {
  const Scene scene = furnished();
  std::vector<std::size_t> order(scene.faceCount());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  Scene shuffled = scene;
  shuffled.face_offset = {0};
  shuffled.corners.clear();
  shuffled.face_surface.clear();
  for (const std::size_t f : order) {
    const auto face = scene.face(f);
    shuffled.corners.insert(shuffled.corners.end(), face.begin(), face.end());
    std::rotate(shuffled.corners.end() - std::ptrdiff_t(face.size()),
                shuffled.corners.end() - std::ptrdiff_t(face.size()) + 1, shuffled.corners.end());
    shuffled.face_offset.push_back(shuffled.corners.size());
    shuffled.face_surface.push_back(scene.face_surface[f]);
  }
  const Built one = build(scene);
  const Built other = build(shuffled);
  EXPECT_EQ(one.complex.vertices, other.complex.vertices);
  ASSERT_EQ(one.complex.polygons.size(), other.complex.polygons.size());
  for (std::size_t p = 0; p < one.complex.polygons.size(); ++p) {
    EXPECT_EQ(one.complex.polygons[p].loops, other.complex.polygons[p].loops);
    EXPECT_EQ(one.complex.polygons[p].surface, other.complex.polygons[p].surface);
  }
}

}  // namespace
}  // namespace radiosity::test
