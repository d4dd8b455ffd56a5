// Lightmaps: every texel that a viewer looks at has the light of the elements there.
#include "radiosity/lightmap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <set>

#include "base/geometry/surface_index.h"
#include "lightmap/charts.h"
#include "support/error_of.h"
#include "support/lit_scene.h"
#include "support/scene_builder.h"

namespace radiosity {
namespace {

using test::dataScene;
using test::LitScene;

/// For tests in which the light does not matter.
constexpr ElementOptions kCoarse{.tolerance = 0.5, .most_vertices = 1000, .rays = 64};

Lightmap mapOf(const LitScene& lit, const LightmapOptions& options) {
  Progress quiet;
  return makeLightmap(lit.scene, lit.mesh, lit.light, options, quiet);
}

struct Sample {
  Vec3 value{0.0};
  bool set = true;  ///< of all four texels
};

/// A viewer's sample: the four texels around a place of the map.
Sample bilinear(const Image& image, const Vec2& uv) {
  const double x = uv.x * image.width - 0.5;
  const double y = uv.y * image.height - 0.5;
  Sample sample;
  for (const int dx : {0, 1}) {
    for (const int dy : {0, 1}) {
      const int column = int(std::floor(x)) + dx;
      const int row = int(std::floor(y)) + dy;
      if (column < 0 || row < 0 || column >= image.width || row >= image.height) {
        sample.set = false;
        continue;
      }
      const double weight = (1 - std::abs(x - column)) * (1 - std::abs(y - row));
      const float* texel =
          &image.rgba[4 * (std::size_t(row) * std::size_t(image.width) + std::size_t(column))];
      sample.set = sample.set && texel[3] == 1;
      sample.value += weight * Vec3(texel[0], texel[1], texel[2]);
    }
  }
  return sample;
}

Vec3 at(const Scene& scene, const LightmapTriangle& t, const Vec3& w) {
  Vec3 p(0.0);
  for (int k = 0; k < 3; ++k) {
    p += w[k] * scene.vertices[scene.face(t.face)[t.corner[std::size_t(k)]]];
  }
  return p;
}

Vec2 uvAt(const LightmapTriangle& t, const Vec3& w) {
  return w.x * t.texcoord[0] + w.y * t.texcoord[1] + w.z * t.texcoord[2];
}

/// The elements' irradiance on the patch of the surface and side that holds the point, by a look at
/// every patch; false if none does.
bool elementsAt(const LitScene& lit, const ElementLookup& lookup, Index surface, int side,
                const Vec3& normal, const Vec3& point, Vec3& value) {
  constexpr double kOnIt = 1e-7;
  const Elements& elements = *lit.light.elements;
  for (std::size_t i = 0; i < lit.mesh.size(); ++i) {
    if (lit.mesh.surface[i] != surface || lit.mesh.side[i] != side) continue;
    if (glm::dot(lit.mesh.normal[i], normal) < 0.999) continue;
    for (std::size_t t = lit.mesh.piece_offset[i]; t < lit.mesh.piece_offset[i + 1]; ++t) {
      const auto& piece = lit.mesh.pieces[t];
      const Vec3& a = lit.mesh.vertices[piece[0]];
      const Vec3& b = lit.mesh.vertices[piece[1]];
      const Vec3& c = lit.mesh.vertices[piece[2]];
      const Vec3 w = nearestOnTriangle(point, a, b, c);
      if (glm::distance(w.x * a + w.y * b + w.z * c, point) > kOnIt) continue;
      std::array<double, 3> sum{};
      const std::size_t root = lookup.rootAt(i, point);
      const Vec2 place = lookup.place(root, point);
      lookup.add(elements.direct, root, place, sum);
      lookup.add(elements.indirect, root, place, sum);
      value = {sum[0], sum[1], sum[2]};
      return true;
    }
  }
  return false;
}

struct Difference {
  double rms = 0;  ///< relative to the root mean square of the light
  std::size_t points = 0;
};

/// Random points of all triangles; corners and edges among them.
Difference differenceOf(const LitScene& lit, const Lightmap& map, int each) {
  const ElementLookup lookup(lit.mesh, lit.light.elements->roots);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  double apart = 0;
  double light = 0;
  Difference found;
  for (const LightmapTriangle& t : map.triangles) {
    const Vec3 a = at(lit.scene, t, {1, 0, 0});
    const Vec3 turn = glm::cross(at(lit.scene, t, {0, 1, 0}) - a, at(lit.scene, t, {0, 0, 1}) - a);
    const double weight = glm::length(turn);
    for (int k = 0; k < each; ++k) {
      double u = share(random);
      double v = share(random);
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      if (k % 4 == 0) v = 0;  // on an edge
      const Vec3 w(1 - u - v, u, v);
      const Sample sample = bilinear(map.image, uvAt(t, w));
      EXPECT_TRUE(sample.set) << "face " << t.face;
      Vec3 truth;
      if (!elementsAt(lit, lookup, lit.scene.face_surface[t.face], t.side, turn / weight,
                      at(lit.scene, t, w), truth))
        continue;
      apart += weight * glm::dot(sample.value - truth, sample.value - truth);
      light += weight * glm::dot(truth, truth);
      ++found.points;
    }
  }
  found.rms = std::sqrt(apart / light);
  return found;
}

/// Interpolation between texels is off by at most what light changes over two texels' diagonals
/// (texels beside a border show its light), so that the error falls at least as fast as texels
/// shrink: four times smaller, a quarter; a half is asked for.
TEST(Lightmap, ShowsTheLightOfElements) {
  for (const char* name : {"cornell-box.obj", "curved.obj"}) {
    const LitScene lit(dataScene(name), 300);
    const Lightmap fine = mapOf(lit, {.size = 1024});
    const Difference at_fine = differenceOf(lit, fine, 40);
    const Difference at_coarse = differenceOf(lit, mapOf(lit, {.size = 256}), 40);
    EXPECT_GT(at_fine.points, 20 * fine.triangles.size() / 2) << name;
    EXPECT_LT(at_fine.rms, 0.005) << name;  // 0.0007 and 0.0021
    EXPECT_LT(at_fine.rms, 0.5 * at_coarse.rms) << name;
    RecordProperty(std::string(name) + " fine", std::to_string(at_fine.rms));
    RecordProperty(std::string(name) + " coarse", std::to_string(at_coarse.rms));
  }
}

/// A closed scene of one emission and reflectance: H = E / (1 - rho) everywhere.
TEST(Lightmap, IsConstantInAFurnace) {
  const LitScene lit(dataScene("furnace-cube.obj"), 60);
  const Lightmap map = mapOf(lit, {.size = 128});
  const Material& wall = lit.scene.materialOf(0);
  const Vec3 truth = wall.emission / (1.0 - wall.reflectance);
  std::size_t set = 0;
  for (std::size_t k = 0; k < map.image.rgba.size(); k += 4) {
    if (map.image.rgba[k + 3] == 0) continue;
    ++set;
    for (std::size_t b = 0; b < 3; ++b) {
      EXPECT_NEAR(map.image.rgba[k + b], truth[int(b)], 1e-6 * truth[int(b)]);  // floats
    }
  }
  EXPECT_EQ(set, map.report.inside + map.report.padding);
  EXPECT_EQ(map.report.dark, 0u);
}

TEST(Lightmap, RadiosityIsEmissionPlusReflectedLight) {
  const LitScene lit(dataScene("furnace-cube.obj"), 60);
  const Lightmap arrives = mapOf(lit, {.size = 64});
  const Lightmap leaves = mapOf(lit, {.size = 64, .shows = LightmapShows::radiosity});
  const Material& wall = lit.scene.materialOf(0);
  for (std::size_t k = 0; k < arrives.image.rgba.size(); k += 4) {
    if (arrives.image.rgba[k + 3] == 0) continue;
    for (std::size_t b = 0; b < 3; ++b) {
      const double expected =
          wall.emission[int(b)] + wall.reflectance[int(b)] * double(arrives.image.rgba[k + b]);
      EXPECT_NEAR(leaves.image.rgba[k + b], expected, 1e-6 * expected);  // floats
    }
  }
}

/// Nothing emits: there is no direct light, and an open floor gets pi L of the sky.
TEST(Lightmap, AnOpenFloorShowsTheSky) {
  test::SceneBuilder builder;
  builder.level(builder.surface("floor", 0.5), 0, 0, 1, 1, 0);
  Scene scene = builder.scene();
  scene.lights = {uniformSky({1, 2, 3})};
  const LitScene lit(scene, 9);
  const Lightmap map = mapOf(lit, {.size = 32});
  EXPECT_EQ(map.report.dark, 0u);
  const Sample sample = bilinear(map.image, uvAt(map.triangles[0], Vec3(1 / 3.0)));
  for (int b = 0; b < 3; ++b) {
    EXPECT_NEAR(sample.value[b], std::numbers::pi * (b + 1),
                1e-6 * (b + 1) * 4);  // floats
  }
}

using Triangle2 = std::array<Vec3, 3>;

Triangle2 texelsOf(const LightmapTriangle& t, int size) {
  Triangle2 p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = Vec3(t.texcoord[k] * double(size), 0.0);
  return p;
}

double distanceTo(const Triangle2& t, const Vec3& p) {
  const Vec3 w = nearestOnTriangle(p, t[0], t[1], t[2]);
  return glm::distance(w.x * t[0] + w.y * t[1] + w.z * t[2], p);
}

/// How deep in the triangle a point lies, whichever way it turns; below 0: outside.
double depthIn(const Triangle2& t, const Vec3& p) {
  const Vec3 turn = glm::cross(t[1] - t[0], t[2] - t[0]);
  double depth = 1e300;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 edge = t[(k + 1) % 3] - t[k];
    depth =
        std::min(depth, glm::cross(edge, p - t[k]).z / glm::length(edge) * (turn.z > 0 ? 1 : -1));
  }
  return depth;
}

/// Bilinear sampling looks at texels whose centre is less than sqrt 2 from the place.
TEST(Lightmap, ChartsShareNoTexelAndDoNotOverlapThemselves) {
  test::SceneBuilder builder;
  builder.level(builder.surface("lamp", 0.5, 5.0), 0, 0, 4, 4, 3, false);
  // A screw of three turns: seen from above it lies over itself.
  const Index screw = builder.surface("screw", 0.5, 0.0, true);
  constexpr int kSteps = 72;
  const auto on = [](int k, double r) {
    const double angle = 6 * std::numbers::pi * k / kSteps;
    return Vec3(2 + r * std::cos(angle), 2 + r * std::sin(angle), 2.0 * k / kSteps);
  };
  for (int k = 0; k < kSteps; ++k) {
    builder.face(screw, {on(k, 0.5), on(k, 1.5), on(k + 1, 1.5)});
    builder.face(screw, {on(k, 0.5), on(k + 1, 1.5), on(k + 1, 0.5)});
  }
  for (const Scene& scene : {dataScene("curved.obj"), builder.scene()}) {
    const LitScene lit(scene, 200, kCoarse);
    constexpr int kSize = 256;
    const Lightmap map = mapOf(lit, {.size = kSize});
    std::vector<Index> owner(kSize * kSize, kNone);
    std::vector<std::uint8_t> covered(kSize * kSize);
    for (const LightmapTriangle& t : map.triangles) {
      const Triangle2 p = texelsOf(t, kSize);
      const auto [low_x, high_x] = std::minmax({p[0].x, p[1].x, p[2].x});
      const auto [low_y, high_y] = std::minmax({p[0].y, p[1].y, p[2].y});
      ASSERT_TRUE(low_x >= 2 && low_y >= 2 && high_x <= kSize - 2 && high_y <= kSize - 2);
      for (int y = int(low_y) - 2; y <= int(high_y) + 2; ++y) {
        for (int x = int(low_x) - 2; x <= int(high_x) + 2; ++x) {
          if (x < 0 || y < 0 || x >= kSize || y >= kSize) continue;
          const Vec3 centre(x + 0.5, y + 0.5, 0);
          if (distanceTo(p, centre) > std::numbers::sqrt2) continue;
          const std::size_t k = std::size_t(y) * kSize + std::size_t(x);
          EXPECT_EQ(map.image.rgba[4 * k + 3], 1) << x << " " << y;
          EXPECT_TRUE(owner[k] == kNone || owner[k] == t.chart) << x << " " << y;
          owner[k] = t.chart;
          // Rounding, and a chart's allowed overlap with itself.
          if (depthIn(p, centre) > 1e-3) ++covered[k];
          EXPECT_LE(covered[k], 1) << x << " " << y;
        }
      }
    }
  }
}

/// Light on either side of a sheet is its own; a side that sees nothing has no chart.
TEST(Lightmap, SidesOfASheetHaveLightOfTheirOwn) {
  test::SceneBuilder builder;
  builder.level(builder.surface("lamp", 0.5, 5.0), 0, 0, 1, 1, 2, false);
  builder.level(builder.surface("sheet", 0.5, 0.0, true), 0, 0, 1, 1, 1);
  builder.level(builder.surface("floor", 0.5), 0, 0, 1, 1, 0);
  const LitScene lit(builder.scene(), 60);
  const Lightmap map = mapOf(lit, {.size = 128});
  ASSERT_EQ(map.triangles.size(), 8u);
  EXPECT_EQ(map.report.charts, 4u);
  const auto mean = [&](Index face, int side) {
    Vec3 sum(0.0);
    for (const LightmapTriangle& t : map.triangles) {
      if (t.face == face && t.side == side)
        sum += bilinear(map.image, uvAt(t, Vec3(1 / 3.0))).value;
    }
    return 0.5 * sum.x;
  };
  EXPECT_GT(mean(1, 0), 1.0);
  EXPECT_LT(mean(1, 1), 0.3 * mean(1, 0)) << "lit by the floor alone";
}

/// Faces of one plane and of one smooth side share a chart: a map of 100,000 triangles would
/// otherwise be padding. A cylinder of 64 sides bends by 5.6 degrees an edge: cones of 30 degrees
/// take it in at most 12 strips.
TEST(Lightmap, SmoothFacesShareCharts) {
  test::SceneBuilder builder;
  builder.prism(builder.surface("column", 0.5, 1.0),
                test::SceneBuilder::regularPolygon({0, 0}, 1, 64), 0, 1);
  const LitScene lit(builder.scene(), 100, kCoarse);
  const Lightmap smooth = mapOf(lit, {.size = 256});
  EXPECT_LE(smooth.report.charts, 12u + 2u);
  EXPECT_GE(smooth.report.least_density, std::cos(kChartCone * std::numbers::pi / 180) - 1e-9);
  EXPECT_EQ(mapOf(lit, {.size = 256, .crease = 1}).report.charts, 66u);
}

TEST(Lightmap, WrongInputIsRefused) {
  EXPECT_NO_THROW(LightmapOptions().validate());
  LitScene lit(dataScene("curved.obj"), 60, kCoarse);
  EXPECT_EQ(test::errorOf([&] { mapOf(lit, {.size = 5000}); }),
            "size: 5000 texels is out of range; 16 to 4096");
  EXPECT_EQ(test::errorOf([&] { mapOf(lit, {.crease = -1}); }),
            "crease: -1 degrees is out of range; 0 to 180");
  const std::string small = test::errorOf([&] { mapOf(lit, {.size = 16}); });
  EXPECT_NE(small.find("a lightmap of 16 x 16 texels has no room for "), std::string::npos)
      << small;
  const int would_do = std::stoi(small.substr(small.find("; ") + 2));
  EXPECT_NO_THROW(mapOf(lit, {.size = would_do}));
  Progress stopped;
  stopped.cancel();
  EXPECT_THROW(makeLightmap(lit.scene, lit.mesh, lit.light, {}, stopped), Cancelled);
  lit.light.elements = nullptr;
  EXPECT_NE(test::errorOf([&] { mapOf(lit, {}); }).find("there are none"), std::string::npos);
}

}  // namespace
}  // namespace radiosity
