// Patch k is face k of the file: nothing welded, cut or re-ordered.
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <set>

#include "mesh/polygons/complex.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::SceneBuilder;

MeshResult asPatches(const Scene& scene) {
  MeshOptions options;
  options.faces_as_patches = true;
  MeshResult made;
  Progress progress;
  made.mesh = facesAsPatches(scene, options, made.report, progress);
  return made;
}

/// A scene over given vertices, which faces share by index.
Scene shared(std::vector<Vec3> vertices, const std::vector<std::vector<Index>>& faces,
             std::vector<Index> surfaces = {}) {
  Scene scene;
  scene.file = "shared";
  scene.vertices = std::move(vertices);
  scene.face_offset = {0};
  scene.materials.resize(1);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    scene.corners.insert(scene.corners.end(), faces[f].begin(), faces[f].end());
    scene.face_offset.push_back(scene.corners.size());
    scene.face_surface.push_back(surfaces.empty() ? 0 : surfaces[f]);
    scene.face_element.push_back(f + 1);
  }
  for (const char* name : {"a", "b"}) scene.surfaces.push_back({name, 0, name});
  return scene;
}

double polygonArea(const PatchMesh& mesh, std::size_t p) {
  Vec3 sum(0.0);
  for (std::size_t l = mesh.polygons.loopBegin(p); l < mesh.polygons.loopEnd(p); ++l) {
    const auto loop = mesh.polygons.loop(l);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      sum += 0.5 * glm::cross(mesh.vertices[loop[k]], mesh.vertices[loop[(k + 1) % loop.size()]]);
    }
  }
  return glm::dot(sum, mesh.polygons.normal[p]);
}

TEST(FacesAsPatches, PatchKIsFaceK) {
  SceneBuilder b;
  const Index s = b.surface("things");
  b.box(s, {0, 0, 0}, {1, 2, 3});
  b.prism(s, SceneBuilder::regularPolygon({5, 5}, 1, 7), 0, 1);
  const auto [mesh, report] = asPatches(b.scene());
  ASSERT_EQ(mesh.size(), b.scene().faceCount());
  EXPECT_EQ(mesh.vertices, b.scene().vertices);
  for (Index f = 0; f < mesh.size(); ++f) {
    EXPECT_EQ(mesh.source_face[f], f);
    EXPECT_EQ(mesh.side[f], 0);
    const auto outline = mesh.outline(f);
    const auto face = b.scene().face(f);
    EXPECT_TRUE(std::equal(outline.begin(), outline.end(), face.begin(), face.end()));
    EXPECT_EQ(mesh.piece_offset[f + 1] - mesh.piece_offset[f], face.size() - 2);
  }
  // The box, and a regular heptagon of radius 1: 7/2 sin(2 pi / 7), sides 2 sin(pi / 7).
  const double heptagon = 3.5 * std::sin(2 * M_PI / 7);
  const double around = 14 * std::sin(M_PI / 7);
  EXPECT_NEAR(report.surfaces[s].kept, 22 + 2 * heptagon + around, 1e-12 * 40);
  EXPECT_EQ(report.surfaces[s].kept, report.surfaces[s].given);
  EXPECT_EQ(report.crossings, 0u);
  EXPECT_EQ(report.t_junctions, 0u);
}

TEST(FacesAsPatches, DegenerateFacesStay) {
  const Scene scene = shared({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}},
                             {{0, 1, 2}, {0, 1, 3}, {1, 1, 2}, {0, 1, 1}, {1, 3, 2}});
  const auto [mesh, report] = asPatches(scene);
  ASSERT_EQ(mesh.size(), 5u);
  EXPECT_EQ(report.degenerate_faces, 3u);
  for (const std::size_t k : {1u, 2u, 3u}) {
    EXPECT_EQ(mesh.area[k], 0);
    EXPECT_EQ(mesh.polygon[k], kNone);
    EXPECT_EQ(mesh.normal[k], Vec3(0.0));
    EXPECT_EQ(mesh.piece_offset[k], mesh.piece_offset[k + 1]);
    EXPECT_EQ(mesh.outline(k).size(), 3u);
  }
  EXPECT_EQ(mesh.area[0], 0.5);
  EXPECT_EQ(mesh.polygons.size(), 1u);
}

bool anyNote(const MeshReport& report, Severity severity, const std::string& text) {
  return std::ranges::any_of(report.notes, [&](const Note& note) {
    return note.severity == severity && note.text.find(text) != std::string::npos;
  });
}

/// A face that repeats another, from any of its corners on; that has its corners the other way
/// round, which is another face; and that differs in one corner.
TEST(FacesAsPatches, FacesThatRepeatOthersHaveNoArea) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 1e-3}, {-0.0, 0, 0}};
  const std::vector<std::vector<Index>> faces{{0, 1, 2}, {2, 4, 1}, {2, 1, 0}, {0, 1, 3}};
  const auto [mesh, report] = asPatches(shared(corners, faces, {0, 1, 1, 1}));
  ASSERT_EQ(mesh.size(), 4u);
  EXPECT_EQ(report.duplicate_faces, 1u);
  EXPECT_EQ(mesh.area[1], 0);
  EXPECT_EQ(mesh.polygon[1], kNone);
  EXPECT_EQ(report.surfaces[1].overlapped, 0.5);
  for (const std::size_t k : {0u, 2u, 3u}) EXPECT_GT(mesh.area[k], 0.4);
  EXPECT_TRUE(anyNote(report, Severity::warning, "1 faces have the corners of others"));
  EXPECT_TRUE(anyNote(report, Severity::warning, "face 1 (b, element 2), which repeats face 0"));

  Scene plates = shared(corners, {{0, 1, 2}, {2, 1, 0}});
  plates.materials[0].two_sided = true;
  EXPECT_EQ(asPatches(plates).report.duplicate_faces, 1u);
}

/// Neighbours, a plate on the other side and one a little above share nothing, wherever they are.
TEST(FacesAsPatches, OverlapsAreReported) {
  struct Case {
    const char* name;
    Vec3 moved;   ///< the second square
    bool upside;  ///< the second faces as the first
    bool overlaps;
  };
  for (const Case& c : std::initializer_list<Case>{{"half", {0.5, 0, 0}, true, true},
                                                   {"corner", {0.9, 0.9, 0}, true, true},
                                                   {"neighbour", {1, 0, 0}, true, false},
                                                   {"diagonal", {1, 1, 0}, true, false},
                                                   {"other side", {0.5, 0, 0}, false, false},
                                                   {"above", {0.5, 0, 1e-3}, true, false}}) {
    for (const Vec3& origin : {Vec3(0.0), Vec3(1e4, -2e4, 3e3)}) {
      std::vector<Vec3> v;
      for (const Vec3& square : {Vec3(0.0), c.moved}) {
        for (const Vec3& at : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}) {
          // Turned about x, so that no plane is an axis'.
          const Vec3 p = square + at;
          v.push_back(origin + Vec3(p.x, 0.8 * p.y - 0.6 * p.z, 0.6 * p.y + 0.8 * p.z));
        }
      }
      std::vector<Index> second{4, 5, 6, 7};
      if (!c.upside) std::ranges::reverse(second);
      const MeshReport report = asPatches(shared(v, {{0, 1, 2, 3}, second})).report;
      EXPECT_EQ(anyNote(report, Severity::loud, "1 pairs of faces overlap"), c.overlaps) << c.name;
    }
  }
}

TEST(FacesAsPatches, ConcaveFaceIsOnePatchWithItsCentroidInside) {
  SceneBuilder b;
  const Index s = b.surface("U");
  // A U whose centre of area lies in its gap.
  b.face(s, {{0, 0, 0},
             {3, 0, 0},
             {3, 3, 0},
             {2.8, 3, 0},
             {2.8, 0.2, 0},
             {0.2, 0.2, 0},
             {0.2, 3, 0},
             {0, 3, 0}});
  const auto [mesh, report] = asPatches(b.scene());
  ASSERT_EQ(mesh.size(), 1u);
  EXPECT_NEAR(mesh.area[0], 9 - 2.6 * 2.8, 1e-14);
  double pieces = 0;
  for (const auto& t : mesh.pieces) {
    const Vec3 area = 0.5 * glm::cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                                       mesh.vertices[t[2]] - mesh.vertices[t[0]]);
    EXPECT_GT(area.z, 0);
    pieces += area.z;
  }
  EXPECT_NEAR(pieces, mesh.area[0], 1e-14);
  const Vec3& c = mesh.centroid[0];
  EXPECT_TRUE(c.y < 0.2 || c.x < 0.2 || c.x > 2.8) << c.x << " " << c.y;
  EXPECT_GT(std::min({c.x, c.y, 3 - c.x, 3 - c.y}), 0);
}

TEST(FacesAsPatches, ConvexFaceKeepsItsCentreOfArea) {
  SceneBuilder b;
  b.face(b.surface("kite"), {{0, 0, 5}, {2, 0, 5}, {2, 1, 5}, {0, 3, 5}});
  const auto [mesh, report] = asPatches(b.scene());
  // Rectangle 2 x 1 below a triangle of base 2 and height 2 over x = 0: areas 2 and 2.
  EXPECT_NEAR(glm::length(mesh.centroid[0] - Vec3((1 + 2.0 / 3) / 2, (0.5 + 5.0 / 3) / 2, 5)), 0,
              1e-15 * 10);
}

TEST(FacesAsPatches, BacksFollowAllFronts) {
  SceneBuilder b;
  const Index sheet = b.surface("sheet", 0.5, 0, true);
  const Index floor = b.surface("floor");
  b.level(sheet, 0, 0, 1, 1, 1);
  b.level(floor, 0, 0, 2, 2, 0);
  b.level(sheet, 1, 0, 2, 1, 1);
  const auto [mesh, report] = asPatches(b.scene());
  ASSERT_EQ(mesh.size(), 5u);
  EXPECT_EQ(mesh.frontCount(), 3u);
  EXPECT_EQ(mesh.twin[0], 3u);
  EXPECT_EQ(mesh.twin[1], kNone);
  EXPECT_EQ(mesh.twin[2], 4u);
  EXPECT_EQ(mesh.twin[4], 2u);
  EXPECT_EQ(mesh.source_face[4], 2u);
  EXPECT_EQ(mesh.normal[4], Vec3(0, 0, -1));
  EXPECT_EQ(mesh.side[4], 1);
  EXPECT_EQ(mesh.index_in_surface[4], 3u);
  EXPECT_EQ(mesh.polygons.back_is_patch[mesh.polygon[0]], 1);
  EXPECT_EQ(mesh.polygons.back_is_patch[mesh.polygon[1]], 0);
}

TEST(FacesAsPatches, CoplanarNeighboursShareAPolygon) {
  // A 3 x 3 grid of quads without its middle, and one quad folded up at the right.
  std::vector<Vec3> vertices;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) vertices.emplace_back(x, y, 0);
  }
  vertices.emplace_back(4, 0, 1);
  vertices.emplace_back(4, 1, 1);
  std::vector<std::vector<Index>> faces;
  for (Index y = 0; y < 3; ++y) {
    for (Index x = 0; x < 3; ++x) {
      const Index v = 4 * y + x;
      if (x != 1 || y != 1) faces.push_back({v, v + 1, v + 5, v + 4});
    }
  }
  faces.push_back({3, 16, 17, 7});
  const auto [mesh, report] = asPatches(shared(vertices, faces));
  ASSERT_EQ(mesh.polygons.size(), 2u);
  EXPECT_EQ(mesh.polygon, (std::vector<Index>{0, 0, 0, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(mesh.polygons.loopEnd(0) - mesh.polygons.loopBegin(0), 2u);
  std::set<Index> corners;
  for (std::size_t l = 0; l < 2; ++l) {
    for (const Index v : mesh.polygons.loop(l)) corners.insert(v);
  }
  EXPECT_EQ(corners.size(), 16u);  // 12 around, those in line included, and 4 at the hole
  EXPECT_NEAR(polygonArea(mesh, 0), 8, 1e-14);
  EXPECT_EQ(mesh.polygons.normal[0], Vec3(0, 0, 1));
  EXPECT_EQ(report.t_junctions, 0u);
}

TEST(FacesAsPatches, OtherSurfacesAndOppositeFacesKeepTheirPolygons) {
  const std::vector<Vec3> p = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  EXPECT_EQ(asPatches(shared(p, {{0, 1, 2, 3}, {1, 4, 5, 2}}, {0, 0})).mesh.polygons.size(), 1u);
  EXPECT_EQ(asPatches(shared(p, {{0, 1, 2, 3}, {1, 4, 5, 2}}, {0, 1})).mesh.polygons.size(), 2u);
  EXPECT_EQ(asPatches(shared(p, {{0, 1, 2, 3}, {1, 2, 5, 4}}, {0, 0})).mesh.polygons.size(), 2u);
  // Three faces at an edge: not merged across it.
  EXPECT_EQ(asPatches(shared({p[0], p[1], p[2], p[3], p[4], p[5], {1, 0, 1}, {1, 1, 1}},
                             {{0, 1, 2, 3}, {1, 4, 5, 2}, {1, 6, 7, 2}}))
                .mesh.polygons.size(),
            3u);
}

TEST(FacesAsPatches, FaceThatIsNotPlanarIsReported) {
  SceneBuilder b;
  b.face(b.surface("bent"), {{0, 0, 0}, {1, 0, 0.2}, {1, 1, 0}, {0, 1, 0.2}});
  const auto [mesh, report] = asPatches(b.scene());
  EXPECT_EQ(report.nonplanar_faces, 1u);
  EXPECT_NEAR(report.largest_deviation, 0.1, 1e-15);
  ASSERT_EQ(mesh.size(), 1u);
  EXPECT_EQ(mesh.normal[0], Vec3(0, 0, 1));
  EXPECT_NEAR(mesh.area[0], 1, 1e-15);
  EXPECT_EQ(mesh.polygons.size(), 1u);
}

TEST(FacesAsPatches, CrossingsAreReportedButNotTouches) {
  for (const bool turn : {false, true}) {
    const auto crossings = [&](const std::vector<std::vector<Vec3>>& faces) {
      SceneBuilder b;
      const Index s = b.surface("s");
      for (const auto& face : faces) b.face(s, face);
      const auto made = asPatches(turn ? test::turned(b.scene()) : b.scene());
      EXPECT_EQ(made.mesh.size(), faces.size());
      return made.report.crossings;
    };
    const std::vector<Vec3> floor = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    // Through the middle, along the diagonal of the floor, through a side, and edge to edge.
    EXPECT_EQ(crossings({floor, {{0.5, 1, -1}, {1.5, 1, -1}, {1.5, 1, 1}, {0.5, 1, 1}}}), 1u);
    EXPECT_EQ(crossings({floor, {{0, 0, -1}, {2, 2, -1}, {2, 2, 1}, {0, 0, 1}}}), 1u);
    EXPECT_EQ(crossings({floor, {{1, 1, -1}, {3, 1, -1}, {3, 1, 1}, {1, 1, 1}}}), 1u);
    EXPECT_EQ(crossings({floor, {{0, 1, -1}, {2, 1, -1}, {2, 1, 1}, {0, 1, 1}}}), 1u);
    // Standing on it, hanging from its side, sharing its edge, lying in its plane, beside it.
    EXPECT_EQ(crossings({floor, {{0.5, 1, 0}, {1.5, 1, 0}, {1.5, 1, 1}, {0.5, 1, 1}}}), 0u);
    EXPECT_EQ(crossings({floor, {{0, 0.5, -1}, {0, 1.5, -1}, {0, 1.5, 1}, {0, 0.5, 1}}}), 0u);
    EXPECT_EQ(crossings({floor, {{0, 0, 0}, {2, 0, 0}, {2, 0, 2}, {0, 0, 2}}}), 0u);
    EXPECT_EQ(crossings({floor, {{1, 1, 0}, {3, 1, 0}, {3, 3, 0}, {1, 3, 0}}}), 0u);
    EXPECT_EQ(crossings({floor, {{2.1, 1, -1}, {3, 1, -1}, {3, 1, 1}, {2.1, 1, 1}}}), 0u);
  }
}

TEST(FacesAsPatches, TJunctionsOfTheFileAreCounted) {
  SceneBuilder b;
  const Index s = b.surface("s");
  b.level(s, 0, 0, 1, 1, 0);
  b.level(s, 1, 0, 2, 0.5, 0);
  b.level(s, 1, 0.5, 2, 1, 0);
  const auto [mesh, report] = asPatches(b.scene());
  // Both squares bring a vertex of their own to the middle of the side.
  EXPECT_EQ(report.t_junctions, 2u);
}

TEST(FacesAsPatches, EmptySceneIsAnError) {
  SceneBuilder b;
  b.surface("nothing");
  EXPECT_THROW(asPatches(b.scene()), InputError);
  b.face(0, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  EXPECT_THROW(asPatches(b.scene()), InputError);
}

TEST(FacesAsPatches, MovingAndScalingKeepAreasAndCrossings) {
  SceneBuilder b;
  const Index s = b.surface("s");
  b.box(s, {0, 0, 0}, {1, 1, 1});
  b.face(s, {{0.5, 0.5, -1}, {0.6, 0.5, -1}, {0.6, 0.5, 2}, {0.5, 0.5, 2}});
  const MeshResult plain = asPatches(b.scene());
  EXPECT_EQ(plain.report.crossings, 2u);
  const MeshResult moved = asPatches(test::moved(b.scene(), {1048576.0, 0, -2097152.0}));
  EXPECT_EQ(moved.report.crossings, 2u);
  // Coordinates near 2e6 keep 2e-10 of their last digit.
  for (std::size_t i = 0; i < plain.mesh.size(); ++i) {
    EXPECT_NEAR(moved.mesh.area[i], plain.mesh.area[i], 1e-9);
  }
  const MeshResult scaled = asPatches(test::scaled(b.scene(), 0.0625));
  for (std::size_t i = 0; i < plain.mesh.size(); ++i) {
    EXPECT_EQ(scaled.mesh.area[i], plain.mesh.area[i] * 0.0625 * 0.0625);
  }
}

TEST(GeometryHash, DependsOnVerticesSidesAndNamesButNotMaterials) {
  const auto hash = [](double height, bool two_sided, const char* name, double reflectance) {
    SceneBuilder b;
    b.level(b.surface(name, reflectance, reflectance, two_sided), 0, 0, 1, 1, height);
    return geometryHash(asPatches(b.scene()).mesh);
  };
  const std::string plain = hash(0, false, "floor", 0.5);
  EXPECT_EQ(plain.size(), 16u);
  EXPECT_EQ(plain, hash(0, false, "floor", 0.9));
  EXPECT_NE(plain, hash(1e-12, false, "floor", 0.5));
  EXPECT_NE(plain, hash(0, true, "floor", 0.5));
  EXPECT_NE(plain, hash(0, false, "Floor", 0.5));
}

}  // namespace
}  // namespace radiosity
