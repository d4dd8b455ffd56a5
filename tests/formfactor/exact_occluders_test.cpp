// Occluders: solids and flat pieces recovered from the polygons, against the polygons themselves.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "exact_scenes.h"
#include "visibility/occluders/hull.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {
namespace {

using test::SceneBuilder;
using test::SightLines;

struct Made {
  explicit Made(const PatchMesh& m) : mesh(m), elements(mesh), set(mesh, elements) {}
  PatchMesh mesh;
  ElementSet elements;
  OccluderSet set;
};

/// Bodies are convex, closed and consistent.
void expectSound(const Made& made) {
  const double near = made.elements.coincidence;
  for (std::size_t k = 0; k < made.set.occluders.size(); ++k) {
    const Occluder& body = made.set.occluders[k];
    EXPECT_EQ(body.flat, k >= made.set.solids);
    EXPECT_EQ(body.flat, body.planes.size() == 2);
    if (!body.flat) {
      EXPECT_EQ(body.corners.size() + body.planes.size(), body.edges.size() + 2);  // Euler
    }
    EXPECT_TRUE(std::is_sorted(body.facets.begin(), body.facets.end()));
    for (const Vec3& corner : body.corners) {
      EXPECT_LE(glm::distance(corner, body.centre), body.radius * (1 + 1e-12));
      for (const Occluder::Plane& plane : body.planes) {
        EXPECT_LE(glm::dot(plane.normal, corner), plane.offset + near);
      }
    }
    for (const Occluder::Edge& edge : body.edges) {
      for (const Index side : {edge.left, edge.right}) {
        const Occluder::Plane& plane = body.planes[side];
        for (const Index end : {edge.from, edge.to}) {
          EXPECT_NEAR(glm::dot(plane.normal, body.corners[end]), plane.offset, near);
        }
      }
      // The face lies to the left of its edge, seen from its front.
      const Occluder::Plane& face = body.planes[edge.left];
      const Vec3 along = body.corners[edge.to] - body.corners[edge.from];
      const Vec3 inward = glm::cross(face.normal, along);
      for (const Vec3& corner : body.corners) {
        if (glm::dot(face.normal, corner) < face.offset - near) continue;
        const double depth = glm::dot(inward, corner - body.corners[edge.from]);
        EXPECT_GE(depth, -2 * near * glm::length(along)) << "body " << k;
      }
    }
  }
}

/// Random lines between patches that face each other are blocked by the occluders if and only if
/// they are blocked by the polygons; lines that pass closer than ten coincidences are left out.
/// `something_blocks`: more than one line in fifty.
void expectBlocksAlike(const PatchMesh& mesh, std::size_t lines, unsigned seed,
                       bool something_blocks = true) {
  const Made made(mesh);
  expectSound(made);
  const SightLines sight(mesh, made.elements);
  const double margin = 10 * made.elements.coincidence;
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::size_t> any(0, made.elements.patch_elements - 1);
  std::size_t blocked = 0;
  std::size_t checked = 0;
  for (std::size_t tries = 0; tries < 40 * lines && checked < lines; ++tries) {
    const std::size_t a = any(random);
    const std::size_t b = any(random);
    const Vec3 p = test::randomPoint(made.elements, a, random);
    const Vec3 q = test::randomPoint(made.elements, b, random);
    const Facet& fa = made.elements.facets[made.elements.facet[a]];
    const Facet& fb = made.elements.facets[made.elements.facet[b]];
    if (glm::dot(fa.normal, q - p) < margin || glm::dot(fb.normal, p - q) < margin) continue;
    ++checked;
    const auto seen = sight.between(p, q, margin);
    if (seen == SightLines::Sight::kBlocked) {
      ++blocked;
      EXPECT_TRUE(test::blocks(made.set.occluders, p, q, -margin)) << a << " " << b;
    } else if (seen == SightLines::Sight::kFree) {
      EXPECT_FALSE(test::blocks(made.set.occluders, p, q, margin)) << a << " " << b;
    }
    if (::testing::Test::HasFailure()) return;
  }
  if (something_blocks) {
    EXPECT_GT(blocked, checked / 50);
  }
  EXPECT_GT(checked, lines / 2);
}

struct OccluderCase {
  const char* name;
  Scene (*make)();
  std::size_t lines;
};

const OccluderCase kOccluderCases[] = {
    {"cornell", [] { return test::dataScene("cornell-box"); }, 20000},
    {"cornell_closed", [] { return test::dataScene("cornell-box-closed"); }, 20000},
    {"blocked_plates", [] { return test::dataScene("blocked-plates"); }, 5000},
    {"two_rooms", [] { return test::dataScene("two-rooms"); }, 20000},
    {"cluttered", [] { return test::dataScene("cluttered"); }, 10000},
    {"curved", [] { return test::dataScene("curved"); }, 5000},
    {"furnished", [] { return test::dataScene("furnished-room"); }, 2000},
    {"hard", test::hardRoom, 20000},
};

class ExactOccluders : public ::testing::TestWithParam<OccluderCase> {};

TEST_P(ExactOccluders, BlockTheSameLinesAsPolygons) {
  expectBlocksAlike(test::meshOf(GetParam().make(), 100), GetParam().lines, 1);
}

TEST_P(ExactOccluders, BlockTheSameLinesAsTurnedPolygons) {
  expectBlocksAlike(test::meshOf(test::turned(GetParam().make()), 100), GetParam().lines / 2, 2);
}

class ExactOccludersOfFaces : public ::testing::TestWithParam<OccluderCase> {};

TEST_P(ExactOccludersOfFaces, BlockTheSameLinesAsPolygons) {
  const Scene scene = GetParam().make();
  const Scene faces = test::sceneOfPatches(test::meshOf(scene, 100), scene);
  expectBlocksAlike(test::meshOf(faces, 1, true), GetParam().lines / 2, 3);
}

std::string nameOf(const ::testing::TestParamInfo<OccluderCase>& tested) {
  return tested.param.name;
}

/// All but the furnished room: finding the occluders among its 10,000 faces takes seconds.
std::vector<OccluderCase> casesOfFaces() {
  std::vector<OccluderCase> cases(std::begin(kOccluderCases), std::end(kOccluderCases));
  std::erase_if(cases, [](const OccluderCase& c) { return std::string(c.name) == "furnished"; });
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactOccluders, ::testing::ValuesIn(kOccluderCases), nameOf);
INSTANTIATE_TEST_SUITE_P(Scenes, ExactOccludersOfFaces, ::testing::ValuesIn(casesOfFaces()),
                         nameOf);

/// The published blocks: 0.165 m and 0.33 m high on quadrilaterals with corners as in the file.
void expectCornellBlocks(const PatchMesh& mesh) {
  const Made made(mesh);
  expectSound(made);
  ASSERT_EQ(made.set.solids, 2u);
  double volume = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(made.set.occluders[k].planes.size(), 6u);
    EXPECT_EQ(made.set.occluders[k].corners.size(), 8u);
    volume += volumeOf(made.set.occluders[k]);
  }
  // Footprints by the shoelace formula from the published corners, times the heights.
  const double expected = 0.027633 * 0.165 + 0.0276265 * 0.33;
  EXPECT_NEAR(volume / std::pow(made.elements.scale, 3), expected, 1e-9 * expected);
}

TEST(ExactSolids, CornellBlocksAreSolidsWithoutTheirContactArea) {
  expectCornellBlocks(test::meshOf(test::dataScene("cornell-box-closed"), 300));
}

TEST(ExactSolids, CornellBlocksAreSolidsOfFaces) {
  expectCornellBlocks(test::meshOf(test::dataScene("cornell-box-closed"), 1, true));
}

/// As they were published: no undersides, and a floor that is not cut.
TEST(ExactSolids, CornellBlocksAreSolidsWithoutUndersides) {
  Scene scene = test::dataScene("cornell-box");
  Scene open = scene;
  open.corners.clear();
  open.face_offset = {0};
  open.face_surface.clear();
  open.face_element.clear();
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    bool on_floor = true;
    for (const Index v : scene.face(f)) on_floor = on_floor && scene.vertices[v].y == 0;
    if (on_floor && scene.surfaces[scene.face_surface[f]].object != "floor") continue;
    open.corners.insert(open.corners.end(), scene.face(f).begin(), scene.face(f).end());
    open.face_offset.push_back(open.corners.size());
    open.face_surface.push_back(scene.face_surface[f]);
    open.face_element.push_back(scene.face_element[f]);
  }
  ASSERT_EQ(open.faceCount() + 2, scene.faceCount());
  expectCornellBlocks(test::meshOf(open, 1, true));
}

SceneBuilder room() {
  SceneBuilder b;
  b.box(b.surface("room"), {0, 0, 0}, {4, 4, 3}, false);
  return b;
}

/// Four sides and a lid, with `height` of the rim.
void openBox(SceneBuilder& b, double height) {
  const Index s = b.surface("box");
  const double z0 = height;
  const double z1 = height + 0.5;
  b.face(s, {{1, 1, z0}, {2, 1, z0}, {2, 1, z1}, {1, 1, z1}});
  b.face(s, {{2, 1, z0}, {2, 2, z0}, {2, 2, z1}, {2, 1, z1}});
  b.face(s, {{2, 2, z0}, {1, 2, z0}, {1, 2, z1}, {2, 2, z1}});
  b.face(s, {{1, 2, z0}, {1, 1, z0}, {1, 1, z1}, {1, 2, z1}});
  b.level(s, 1, 1, 2, 2, z1);
}

TEST(ExactSolids, AnOpenBoxInTheAirIsNoSolid) {
  SceneBuilder b = room();
  openBox(b, 1.0);
  const Made made(test::meshOf(b.scene(), 1, true));
  EXPECT_EQ(made.set.solids, 0u);
  EXPECT_EQ(made.set.occluders.size(), 5u);
}

TEST(ExactSolids, AnOpenBoxOnATableIsASolid) {
  SceneBuilder b = room();
  openBox(b, 1.0);
  b.box(b.surface("table"), {0.5, 0.5, 0.9}, {3, 3, 1.0});
  const Made made(test::meshOf(b.scene(), 1, true));
  EXPECT_EQ(made.set.solids, 2u);
  EXPECT_EQ(made.set.occluders.size(), 2u);
}

/// Two one-sided sheets back to back, as modellers make them: an outer one, whose faces are in
/// convex position, and an inner one, whose faces see each other.
void sheetsBackToBack(SceneBuilder& b, const std::vector<std::vector<Vec3>>& outer) {
  const Index outside = b.surface("outside");
  const Index inside = b.surface("inside");
  for (const std::vector<Vec3>& face : outer) {
    b.face(outside, face);
    b.face(inside, {face.rbegin(), face.rend()});
  }
}

std::vector<std::vector<Vec3>> sides(double low, double high) {
  std::vector<std::vector<Vec3>> faces;
  const std::vector<Vec2> corners{{1, 1}, {2, 1}, {2, 2}, {1, 2}};
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2& a = corners[k];
    const Vec2& c = corners[(k + 1) % 4];
    faces.push_back({{a.x, a.y, low}, {c.x, c.y, low}, {c.x, c.y, high}, {a.x, a.y, high}});
  }
  return faces;
}

void expectNoSolidAndBlocksAlike(SceneBuilder& b) {
  for (const bool as_they_are : {false, true}) {
    const PatchMesh mesh = test::meshOf(b.scene(), 200, as_they_are);
    EXPECT_EQ(Made(mesh).set.solids, 0u);
    expectBlocksAlike(mesh, 2000, 5, false);  // a sheet hides what is outside by the horizon alone
  }
}

TEST(ExactSolids, AHollowCubeOfTwoSheetsIsNoSolid) {
  SceneBuilder b;
  std::vector<std::vector<Vec3>> faces = sides(0, 1);
  faces.push_back({{1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}});
  faces.push_back({{1, 1, 1}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}});
  sheetsBackToBack(b, faces);
  expectNoSolidAndBlocksAlike(b);
}

/// Open at the top, with all of the scene below; and with walls that continue outwards.
TEST(ExactSolids, ABasinOfTwoSheetsIsNoSolid) {
  for (const bool flared : {false, true}) {
    SceneBuilder b;
    std::vector<std::vector<Vec3>> faces = sides(0, 1);
    faces.push_back({{1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}});
    if (flared) {
      const std::size_t walls = 4;
      for (std::size_t k = 0; k < walls; ++k) {
        const Vec3 a = faces[k][3];
        const Vec3 c = faces[k][2];
        const auto out = [](const Vec3& p) {
          return Vec3(p.x < 1.5 ? p.x - 0.5 : p.x + 0.5, p.y < 1.5 ? p.y - 0.5 : p.y + 0.5, 2.0);
        };
        faces.push_back({a, c, out(c), out(a)});
      }
    }
    sheetsBackToBack(b, faces);
    expectNoSolidAndBlocksAlike(b);
  }
}

TEST(ExactSolids, ASheetAndTheFacesOfAnInnerRoomAreFlat) {
  SceneBuilder b = room();
  const Index sheet = b.surface("sheet", 0.5, 0.0, true);
  b.level(sheet, 1, 1, 2, 2, 1.5);
  b.box(b.surface("inner"), {2.5, 2.5, 1}, {3, 3, 2}, false);  // fronts look inside: a room
  const Made made(test::meshOf(b.scene(), 1, true));
  EXPECT_EQ(made.set.solids, 0u);
  EXPECT_EQ(made.set.occluders.size(), 7u);
  EXPECT_EQ(made.set.skipped_hull, 6u);
}

/// A quad that is not planar by some coincidences, once with each diagonal: the planes of its faces
/// cross in no reliable place, and points beside it would be inside all of them.
TEST(ExactSolids, KnifeEdgesMakeNoSolid) {
  const auto hullOf = [](double off) {
    const std::vector<Vec3> p{{0, 0, 0}, {0.3, 0, off}, {0.3, 0.3, 0}, {0, 0.3, off}};
    std::vector<Occluder::Plane> planes;
    for (const auto& [a, b, c] : {std::array{0, 1, 3}, {1, 2, 3}, {0, 2, 1}, {0, 3, 2}}) {
      const Vec3 normal = glm::normalize(glm::cross(p[b] - p[a], p[c] - p[a]));
      planes.push_back({normal, glm::dot(normal, p[a])});
    }
    return convexHull(p, planes, 5e-8);
  };
  EXPECT_FALSE(hullOf(4e-7));
  EXPECT_FALSE(hullOf(1e-5));
  EXPECT_TRUE(hullOf(1e-2));
}

/// Boxes side by side with dropped contact areas, of different heights and depths: one solid each,
/// however their faces were cut.
TEST(ExactSolids, BooksOnABoardAreASolidEach) {
  SceneBuilder b = room();
  b.box(b.surface("board"), {1, 1, 1}, {3, 2, 1.1});
  const Index books = b.surface("books");
  double x = 1.2;
  const double sizes[][3] = {{0.1, 0.5, 0.6}, {0.15, 0.6, 0.5}, {0.12, 0.55, 0.7}, {0.1, 0.4, 0.4}};
  for (const auto& [thick, deep, tall] : sizes) {
    b.box(books, {x, 1.2, 1.1}, {x + thick, 1.2 + deep, 1.1 + tall});
    x += thick;
  }
  const Made made(test::meshOf(b.scene(), 200));
  expectSound(made);
  EXPECT_EQ(made.set.solids, 5u);
  EXPECT_EQ(made.set.occluders.size(), 5u);
}

/// Pieces of plates, and how many: a square frame takes four, an L two; two rectangles of different
/// surfaces side by side one.
TEST(ExactPieces, PlatesMakeFewPieces) {
  const auto piecesOf = [](const std::vector<std::vector<Vec2>>& faces) {
    SceneBuilder b = room();
    Index k = 0;
    for (const std::vector<Vec2>& face : faces) {
      std::vector<Vec3> corners;
      corners.reserve(face.size());
      for (const Vec2& p : face) corners.emplace_back(p.x + 1, p.y + 1, 1.5);
      b.face(b.surface("plate" + std::to_string(k++), 0.5, 0.0, true), corners);
    }
    const Made made(test::meshOf(b.scene(), 50));
    expectSound(made);
    return made.set.occluders.size();
  };
  EXPECT_EQ(piecesOf({{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}}), 2u);
  EXPECT_EQ(piecesOf({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {{1, 0}, {2, 0}, {2, 1}, {1, 1}}}), 1u);
  EXPECT_EQ(piecesOf({{{0, 0}, {2, 0}, {2, 0.5}, {0, 0.5}},
                      {{0, 1.5}, {2, 1.5}, {2, 2}, {0, 2}},
                      {{0, 0.5}, {0.5, 0.5}, {0.5, 1.5}, {0, 1.5}},
                      {{1.5, 0.5}, {2, 0.5}, {2, 1.5}, {1.5, 1.5}}}),
            4u);
}

/// Two faces back to back without thickness are one flat occluder on four facets' planes.
TEST(ExactPieces, FacesBackToBackAreOneOccluder) {
  const Made made(test::meshOf(test::dataScene("blocked-plates"), 100));
  ASSERT_EQ(made.set.occluders.size(), 1u);
  EXPECT_TRUE(made.set.occluders[0].flat);
  EXPECT_EQ(made.set.occluders[0].facets.size(), 2u);
  for (const std::uint8_t hidden : made.set.hidden_facets) EXPECT_EQ(hidden, 0);
}

}  // namespace
}  // namespace radiosity
