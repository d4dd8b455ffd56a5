// Meshing of any geometry: nothing throws, area is conserved, unrepaired faults are reported.
// Every scene is tried as it is, turned by one radian about a skew axis, and a million units away.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "mesh/polygons/complex.h"
#include "radiosity/patch_mesh.h"
#include "support/scene_builder.h"

namespace radiosity::test {
namespace {

MeshResult meshed(const Scene& scene, std::size_t patches = 300, double weld = 1e-7) {
  Progress progress;
  MeshOptions options;
  options.patches = patches;
  options.weld = weld;
  return meshScene(scene, options, progress);
}

bool saysWhy(const MeshReport& report, const std::string& text) {
  return std::any_of(report.notes.begin(), report.notes.end(),
                     [&](const Note& n) { return n.text.find(text) != std::string::npos; });
}

void expectAreaConserved(const MeshReport& report) {
  for (const SurfaceAreas& s : report.surfaces) {
    // Sums of some thousand areas, each rounded.
    EXPECT_NEAR(s.kept + s.buried + s.overlapped + s.degenerate, s.given, 1e-9 * s.given) << s.name;
  }
}

void expectPatchesWithArea(const PatchMesh& m) {
  for (std::size_t i = 0; i < m.size(); ++i) {
    EXPECT_GT(m.area[i], 0) << i;
    EXPECT_TRUE(std::isfinite(m.centroid[i].x + m.centroid[i].y + m.centroid[i].z)) << i;
  }
}

/// Area lost because it is thinner than the coincidence: hardly any.
double lost(const MeshReport& report) {
  double given = 0;
  double degenerate = 0;
  for (const SurfaceAreas& s : report.surfaces) {
    given += s.given;
    degenerate += std::abs(s.degenerate);
  }
  return degenerate / given;
}

void everywhere(const Scene& scene, const std::function<void(const MeshResult&)>& expect,
                double weld = 1e-7) {
  for (const auto& [where, placed] :
       {std::pair{"as it is", scene}, std::pair{"turned", turned(scene)},
        std::pair{"far away", moved(scene, {1e6, -2e6, 3e6})}}) {
    SCOPED_TRACE(where);
    const MeshResult result = meshed(placed, 300, weld);
    expectAreaConserved(result.report);
    expectPatchesWithArea(result.mesh);
    if (result.report.t_junctions > 0) {
      EXPECT_TRUE(saysWhy(result.report, "vertices lie on edges"));
    }
    expect(result);
  }
}

/// A sphere of quads and triangles, `n` around.
void addSphere(SceneBuilder& b, Index surface, const Vec3& centre, double radius, int n) {
  const auto at = [&](int i, int j) {
    const double theta = 2 * std::numbers::pi * i / n;
    const double phi = 2 * std::numbers::pi * (j % n) / n;
    if (i == 0 || i == n / 2) return centre + Vec3(0, 0, i == 0 ? radius : -radius);
    return centre + radius * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                  std::cos(theta));
  };
  for (int i = 0; i < n / 2; ++i) {
    for (int j = 0; j < n; ++j) {
      if (i > 0) b.face(surface, {at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i + 1 < n / 2) b.face(surface, {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
}

TEST(AnyGeometry, AnEdgeThatLeavesThePlaneItTouchedCutsItNoFarther) {
  // The triangle's lower side lies on the floor up to its middle corner and rises from there by
  // three coincidences, which is straight, past the rim of the floor.
  SceneBuilder b;
  const Index floor = b.surface("floor");
  const Index sail = b.surface("sail", 0.5, 0, true);
  const double c = 1e-7 * std::sqrt(10.0 * 10.0 + 8.0 * 8.0 + 4.0 * 4.0);
  b.level(floor, -2, -5, 5, 5, 0);
  b.face(sail, {{1, 0, 0}, {4, 0, 0.9 * c}, {8, 0, 3 * c}, {4, 0, 4}});
  Progress progress;
  MeshReport report;
  const CoarseComplex complex = buildComplex(b.scene(), {}, report, progress);
  for (const CoarsePolygon& p : complex.polygons) {
    if (p.surface != floor) continue;
    ASSERT_EQ(p.inner_edges.size(), 1u);
    for (const Index v : p.inner_edges[0]) {
      EXPECT_LE((complex.vertices[v] + complex.origin).x, 4.0 + c);
    }
  }
  everywhere(b.scene(), [&](const MeshResult& r) { EXPECT_EQ(r.report.t_junctions, 0u); });
}

TEST(AnyGeometry, BowTiesAndSelfCrossingPolygonsAreMeshed) {
  SceneBuilder b;
  const Index bow = b.surface("bow");
  b.face(bow, {{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 3, 0}});
  b.face(bow, {{4, 0, 0}, {4, 2, 1}, {6, 0, 0}, {6, 2, 1}});
  // A star of five points drawn in one line.
  std::vector<Vec3> star;
  star.reserve(5);
  for (int k = 0; k < 5; ++k) {
    const double a = 4 * std::numbers::pi * k / 5;
    star.emplace_back(10 + 2 * std::cos(a), 2 * std::sin(a), 0.0);
  }
  b.face(bow, star);
  everywhere(b.scene(), [](const MeshResult& r) {
    EXPECT_TRUE(saysWhy(r.report, "cross"));
    EXPECT_GT(r.mesh.size(), 10u);
  });
}

TEST(AnyGeometry, DoubledFlippedAndBackToBackFacesAreMeshed) {
  SceneBuilder b;
  const Index wall = b.surface("wall");
  const Index other = b.surface("other");
  for (int twice = 0; twice < 2; ++twice) {
    b.face(wall, {{0, 0, 0}, {3, 0, 0}, {3, 0, 2}, {0, 0, 2}});
    b.face(wall, {{3, 0, 0}, {0, 0, 0}, {0, 0, 2}, {3, 0, 2}});
  }
  b.face(other, {{1, 0, 1}, {4, 0, 1}, {4, 0, 3}, {1, 0, 3}});
  b.face(other, {{4, 1e-9, 1}, {1, 1e-9, 1}, {1, 1e-9, 3}, {4, 1e-9, 3}});
  everywhere(b.scene(), [](const MeshResult& r) {
    EXPECT_EQ(r.report.t_junctions, 0u);
    EXPECT_EQ(r.report.duplicate_faces, 2u);
  });
}

TEST(AnyGeometry, SliversAndTheirFansLoseHardlyAnyArea) {
  SceneBuilder b;
  const Index fan = b.surface("fan");
  const Index disc = b.surface("disc");
  const int n = 300;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    const double e = 2 * std::numbers::pi * (k + 1) / n;
    // A cone of slivers from one point, and a tube of slivers that are not planar pairs.
    b.face(fan, {{0, 0, 5}, {std::cos(a), std::sin(a), 0}, {std::cos(e), std::sin(e), 0}});
    b.face(disc, {{3 + 0.01 * std::cos(a), 0.01 * std::sin(a), 0},
                  {3 + 0.01 * std::cos(e), 0.01 * std::sin(e), 0},
                  {3 + 0.01 * std::cos(e + 0.1), 0.01 * std::sin(e + 0.1), 4}});
  }
  everywhere(b.scene(), [](const MeshResult& r) { EXPECT_LT(lost(r.report), 1e-5); });
}

TEST(AnyGeometry, CrossingBodiesLoseTheirInnerParts) {
  SceneBuilder b;
  const Index a = b.surface("a");
  const Index c = b.surface("c");
  addSphere(b, a, {0, 0, 0}, 1, 16);
  addSphere(b, c, {0.7, 0.31, 0.23}, 0.9, 14);
  b.box(b.surface("box"), {-0.3, -2, -0.2}, {0.4, 2, 0.6});
  everywhere(b.scene(), [&](const MeshResult& r) {
    EXPECT_EQ(r.report.t_junctions, 0u);
    // Parts of closed bodies inside another are gone.
    EXPECT_GT(r.report.surfaces[a].buried, 0.05 * r.report.surfaces[a].given);
    EXPECT_GT(r.report.surfaces[c].buried, 0.05 * r.report.surfaces[c].given);
  });
}

TEST(AnyGeometry, EdgesOfManyFacesAreMeshed) {
  // A book: twelve pages at one spine, some doubled, one page of triangles that share the spine.
  SceneBuilder b;
  const Index page = b.surface("page");
  for (int k = 0; k < 12; ++k) {
    const double a = 0.5 * k;
    const Vec3 out(std::cos(a), std::sin(a), 0);
    b.face(page, {{0, 0, 0}, out, out + Vec3(0, 0, 1), {0, 0, 1}});
    if (k % 3 == 0) b.face(page, {{0, 0, 0.5}, {0, 0, 0.25}, 0.5 * out});
  }
  everywhere(b.scene(), [](const MeshResult& r) {
    EXPECT_EQ(r.report.t_junctions, 0u);
    EXPECT_GT(r.report.nonmanifold_edges, 0u);
  });
}

TEST(AnyGeometry, MillimetreDetailsAThousandKilometresAwayAreKept) {
  SceneBuilder b;
  b.box(b.surface("house"), {0, 0, 0}, {12, 9, 7});
  const Index rail = b.surface("rail");
  for (int k = 0; k < 8; ++k) {
    b.box(rail, {0.5 + 0.02 * k, -1, 0}, {0.501 + 0.02 * k, -0.999, 1});
  }
  b.level(b.surface("ground"), -20, -20, 30, 30, 0);
  everywhere(b.scene(), [&](const MeshResult& r) {
    EXPECT_GT(r.report.surfaces[rail].kept, 0.9 * r.report.surfaces[rail].given);
  });
}

/// Triangles with corners on a coarse lattice of some coincidences, moved by parts of one: edges
/// that nearly meet everywhere.
Scene noise(unsigned seed, std::size_t triangles, double coincidence) {
  SceneBuilder b;
  const Index soup = b.surface("soup");
  std::mt19937 random(seed);
  const auto uniform = [&] { return double(random()) / 4294967296.0; };
  const auto corner = [&] {
    const auto place = [&] { return coincidence * (3.0 * double(random() % 8) + 2.0 * uniform()); };
    const double x = place();
    const double y = place();
    return Vec3(x, y, place());
  };
  for (std::size_t k = 0; k < triangles; ++k) {
    const Vec3 p = corner();
    const Vec3 q = corner();
    b.face(soup, {p, q, corner()});
  }
  // A large face, so that the details are small.
  b.level(b.surface("floor"), -0.5, -0.5, 0.5, 0.5, 0);
  return b.scene();
}

TEST(AnyGeometry, NoiseAsLargeAsTheCoincidenceIsMeshed) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    everywhere(noise(seed, 40, 1.5e-7), [](const MeshResult& r) { EXPECT_GT(r.mesh.size(), 50u); });
  }
}

TEST(AnyGeometry, ASmallThingBesideALargeOneKeepsItsFaces) {
  // A craft of a metre, 400 km over a ball of 6.4e6 m: the coincidence of the ball is 2 m.
  SceneBuilder b;
  addSphere(b, b.surface("ball"), {0, 0, 0}, 6.4e6, 12);
  const double up = 6.8e6;
  b.level(b.surface("plate"), 0, 0, 1, 1, up, false);
  b.box(b.surface("body"), {0, 0, up + 1}, {0.5, 0.2, up + 1.5});
  everywhere(b.scene(), [](const MeshResult& r) {
    // Coordinates of 7e6 m are rounded by 1e-9 m.
    EXPECT_NEAR(r.report.surfaces[1].kept, 1, 1e-6);
    EXPECT_NEAR(r.report.surfaces[2].kept, 0.9, 1e-6);
    ASSERT_TRUE(r.mesh.coincidence);
    EXPECT_LE(*r.mesh.coincidence, 1e-4);
  });
}

TEST(AnyGeometry, ASurfaceThatWouldVanishIsRefused) {
  SceneBuilder b;
  b.level(b.surface("floor"), 0, 0, 4, 3, 0);
  b.level(b.surface("thread"), 1, 1, 3, 1 + 1e-8, 1);
  try {
    meshed(b.scene());
    FAIL() << "meshed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("thread"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("smaller weld"), std::string::npos) << error.what();
  }
  EXPECT_NEAR(meshed(b.scene(), 300, 1e-12).report.surfaces[1].kept, 2e-8, 1e-14);
}

TEST(AnyGeometry, AGapThatWeldingClosesIsNoted) {
  for (const double gap : {1e-9, 1e-8, 1e-7}) {
    SceneBuilder facing;
    facing.level(facing.surface("low"), 0, 0, 1, 1, 0);
    facing.level(facing.surface("high"), 0, 0, 1, 1, gap, false);
    // The same place turned away is a sheet of two sides.
    SceneBuilder away;
    away.level(away.surface("low"), 0, 0, 1, 1, 0, false);
    away.level(away.surface("high"), 0, 0, 1, 1, gap);
    for (const bool turn : {false, true}) {
      const auto placed = [&](SceneBuilder& b) { return turn ? turned(b.scene()) : b.scene(); };
      EXPECT_TRUE(saysWhy(meshed(placed(facing)).report, "low/low and high/high face each other"));
      EXPECT_FALSE(saysWhy(meshed(placed(away)).report, "face each other"));
      EXPECT_FALSE(saysWhy(meshed(placed(facing), 300, 1e-12).report, "face each other"));
    }
  }
}

TEST(AnyGeometry, NoiseUnderACoarseWeldIsMeshed) {
  for (unsigned seed = 11; seed <= 14; ++seed) {
    SCOPED_TRACE(seed);
    everywhere(
        noise(seed, 80, 1.5e-2), [](const MeshResult& r) { EXPECT_GT(r.mesh.size(), 50u); }, 1e-2);
  }
}

TEST(AnyGeometry, APolygonOfTwentyThousandCornersIsMeshed) {
  SceneBuilder b;
  const Index plate = b.surface("plate");
  std::vector<Vec3> corners;
  corners.reserve(20000);
  for (int k = 0; k < 20000; ++k) {
    const double a = 2 * std::numbers::pi * k / 20000;
    const double r = 1 + 0.1 * std::sin(40 * a);
    corners.emplace_back(r * std::cos(a), r * std::sin(a), 0.0);
  }
  b.face(plate, corners);
  // And one that is not planar.
  for (std::size_t k = 0; k < corners.size(); ++k) corners[k].z = 2 + (k % 2 == 0 ? 1e-3 : 0.0);
  b.face(plate, corners);
  const MeshResult r = meshed(b.scene());
  expectAreaConserved(r.report);
  expectPatchesWithArea(r.mesh);
  EXPECT_EQ(r.report.nonplanar_faces, 1u);
}

}  // namespace
}  // namespace radiosity::test
