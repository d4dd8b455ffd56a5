// The gather method at vertices: eyes at creases, interpolation of seen light, accounts.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "gather/eyes.h"
#include "gather/passes.h"
#include "gather/patch_basis.h"
#include "gather_scenes.h"
#include "support/colours.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;
using test::Room;

GatherOptions atVertices(int passes = 100, int resolution = 64) {
  GatherOptions options;
  options.passes = passes;
  options.resolution = resolution;
  return options;
}

TEST(GatherAtVertices, EveryClosedSceneIsAFurnaceAtEveryVertex) {
  // B = E / (1 - rho) = 4/3 whatever is seen, if no eye loses a pixel and interpolation keeps
  // constants. Left over: 4^-14 = 4e-9 of the passes and float rounding, 6e-8 of B over 1 - rho.
  for (const char* scene : {"furnace-cube", "cornell-box-closed", "two-rooms", "curved"}) {
    Room room = test::loadRoom(scene, 150);
    test::makeUniform(room, 0.25, 1.0);
    GatherOptions options = atVertices(14, 32);
    options.tolerance = 1e-12;
    const Gathered gathered = test::gathered(room, options);
    EXPECT_TRUE(gathered.summary.closed) << scene;
    EXPECT_EQ(gathered.summary.hemicubes, gathered.area.size()) << scene;
    for (const float b : gathered.radiosity) ASSERT_NEAR(b, 4.0 / 3, 1e-6) << scene;
    for (const float sky : gathered.sky) ASSERT_EQ(sky, 0.0F) << scene;
    for (const float backs : gathered.backs) ASSERT_EQ(backs, 0.0F) << scene;
  }
}

TEST(GatherAtVertices, AreasAddUpAndAccountForAllEnergy) {
  for (const char* scene : {"cornell-box", "curved", "two-rooms"}) {
    const Room room = test::loadRoom(scene, 300);
    const Gathered gathered = test::gathered(room, atVertices(3, 32));
    const double area = std::accumulate(room.mesh.area.begin(), room.mesh.area.end(), 0.0);
    EXPECT_NEAR(std::accumulate(gathered.area.begin(), gathered.area.end(), 0.0), area,
                1e-9 * area);
    Vec3 emitted(0.0);
    for (std::size_t i = 0; i < room.mesh.size(); ++i) {
      emitted += room.mesh.area[i] * test::rgbAt(room.materials.emission, i);
    }
    for (const GatherPass& pass : gathered.summary.passes) {
      for (std::size_t b = 0; b < 3; ++b) {
        const EnergyAccount& e = pass.energy;
        // Emissions are floats.
        EXPECT_NEAR(e.emitted[b], emitted[int(b)], 1e-6 * emitted[int(b)]) << scene;
        EXPECT_NEAR(
            e.emitted[b],
            e.absorbed[b] + e.to_sky[b] + e.on_backs[b] + pass.in_flight[b] + e.imbalance[b],
            1e-12 * e.emitted[b]);
      }
    }
    const std::vector<double> means = patchRadiosity(room.mesh, gathered);
    double by_patch = 0;
    double by_eye = 0;
    for (std::size_t i = 0; i < room.mesh.size(); ++i) by_patch += room.mesh.area[i] * means[3 * i];
    for (std::size_t k = 0; k < gathered.area.size(); ++k) {
      by_eye += gathered.area[k] * gathered.radiosity[3 * k];
    }
    EXPECT_NEAR(by_patch, by_eye, 1e-9 * by_eye) << scene;
  }
}

/// A room in two by a sheet without thickness, light on one side only.
Room splitRoom() {
  MeshBuilder builder;
  const int n = 3;
  const auto half = [&](const std::string& name, double x0, double x1) {
    const Vec3 o(x0, 0, 0);
    const Vec3 x(x1 - x0, 0, 0), y(0, 1, 0), z(0, 0, 1);
    builder.grid(name + "front", o, z, x, n, n);
    builder.grid(name + "back", o + y, x, z, n, n);
  };
  // Floor and ceiling reach through under and over the sheet, as one polygon each.
  builder.grid("floor", {0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 2 * n, n);
  builder.grid("ceiling", {0, 0, 1}, {0, 1, 0}, {2, 0, 0}, n, 2 * n);
  half("lit ", 0, 1);
  half("dark ", 1, 2);
  builder.grid("lamp", {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, n);
  builder.grid("end", {2, 0, 0}, {0, 0, 1}, {0, 1, 0}, n, n);
  builder.grid("sheet", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, n, true);
  Room room{builder.build(), {}};
  test::makeUniform(room, 0.5, 0.0);
  for (std::size_t i = 0; i < room.mesh.size(); ++i) {
    if (room.mesh.surface_names[room.mesh.surface[i]] == "lamp")
      test::setRgb(room.materials.emission, i, Vec3(1));
  }
  return room;
}

TEST(GatherAtVertices, NoLightLeaksUnderASheet) {
  const Room room = splitRoom();
  const Gathered gathered = test::gathered(room, atVertices(8));
  const std::vector<double> corners = cornerRadiosity(room.mesh, gathered);
  std::size_t dark = 0;
  for (std::size_t i = 0; i < room.mesh.size(); ++i) {
    const double x = room.mesh.centroid[i].x;
    const bool in_sheet = std::abs(x - 1) < 1e-9;
    const bool behind = in_sheet ? room.mesh.normal[i].x > 0 : x > 1;
    for (std::size_t c = room.mesh.corner_offset[i]; c < room.mesh.corner_offset[i + 1]; ++c) {
      if (behind) {
        ASSERT_EQ(corners[3 * c], 0.0) << room.mesh.surface_names[room.mesh.surface[i]];
      } else {
        ASSERT_GT(corners[3 * c], 0.05) << room.mesh.surface_names[room.mesh.surface[i]];
      }
    }
    dark += behind;
  }
  EXPECT_EQ(dark, room.mesh.size() / 2);
}

TEST(GatherAtVertices, ADoorwayPassesLittleLight) {
  const Room room = test::loadRoom("two-rooms", 600);
  const Gathered gathered = test::gathered(room, atVertices(30));
  const std::vector<double> means = patchRadiosity(room.mesh, gathered);
  const auto meanOf = [&](const std::string& name) {
    double sum = 0;
    double area = 0;
    for (std::size_t i = 0; i < room.mesh.size(); ++i) {
      if (room.mesh.surface_names[room.mesh.surface[i]] != name) continue;
      sum += room.mesh.area[i] * means[3 * i];
      area += room.mesh.area[i];
    }
    return sum / area;
  };
  EXPECT_GT(meanOf("dark_floor/wood"), 0.0);
  EXPECT_LT(meanOf("dark_floor/wood"), 0.2 * meanOf("lit_floor/wood"));
  // The same light as gathered at patch centres, the matrix's eyes: coarse patches differ by some
  // per cent.
  Progress quiet;
  GatherOptions options = atVertices(30);
  options.at = GatherAt::patches;
  const Gathered at_patches = gather(room.mesh, room.materials, options, quiet);
  double difference = 0;
  double norm = 0;
  for (std::size_t i = 0; i < room.mesh.size(); ++i) {
    const double b = at_patches.radiosity[3 * i];
    difference += room.mesh.area[i] * (means[3 * i] - b) * (means[3 * i] - b);
    norm += room.mesh.area[i] * b * b;
  }
  EXPECT_LT(std::sqrt(difference / norm), 0.1);
}

TEST(GatherAtVertices, EyesStandOnTheirOwnSideOfACrease) {
  const MeshBuilder builder = test::roomWithBlock(2);
  const PatchMesh mesh = builder.build();
  const CornerGroups groups = cornerGroups(mesh, 30);
  const std::vector<Eye> eyes = vertexEyes(mesh, groups, GatherOptions());
  std::size_t moved = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const Index patch = groups.patchesOf(g).front();
    const Vec3& vertex = mesh.vertices[mesh.corners[groups.cornersOf(g).front()]];
    ASSERT_TRUE(eyes[g].looks);
    ASSERT_LT(glm::distance(eyes[g].normal, mesh.normal[patch]), 1e-15);
    ASSERT_EQ(eyes[g].own, mesh.polygon[patch]);
    ASSERT_NEAR(glm::dot(eyes[g].position - vertex, eyes[g].normal), 0.0, 1e-15);
    // Inside the room, outside the block, and off every other wall by a share of the patches.
    const Vec3& p = eyes[g].position;
    for (std::size_t k = 0; k < mesh.polygons.size(); ++k) {
      if (k == eyes[g].own) continue;
      const double height = glm::dot(mesh.polygons.normal[k], p - mesh.polygons.origin[k]);
      if (mesh.polygons.normal[k] == eyes[g].normal) continue;
      const bool over_block = mesh.surface_names[mesh.polygons.surface[k]] == "block";
      ASSERT_TRUE(over_block || height > 1e-3) << g;
    }
    ASSERT_FALSE(p.x > 0.3 && p.x < 0.6 && p.y > 0.3 && p.y < 0.6 && p.z < 0.45) << g;
    moved += p != vertex;
    ASSERT_LE(glm::distance(p, vertex), 0.1 * 0.5 + 1e-12);
  }
  // The vertices off all edges: one a wall and block face of 2 x 2, and on the floor those of a
  // 6 x 6 grid without the hole's 2 x 2 that have patches all round.
  EXPECT_EQ(groups.size() - moved, 5u + 5u + (25u - 9u));
}

/// A field over a polygon seen by one eye: irradiance through the hemicube.
double irradianceOf(const PatchMesh& mesh, const Vec3& eye, int resolution,
                    const std::function<double(const Vec3&)>& field) {
  std::vector<Index> eye_of_corner(mesh.corners.size());
  std::vector<float> radiosity(3 * mesh.corners.size());
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    eye_of_corner[c] = Index(c);
    for (std::size_t b = 0; b < 3; ++b) {
      radiosity[3 * c + b] = float(field(mesh.vertices[mesh.corners[c]]));
    }
  }
  FormFactorOptions options;
  options.resolution = resolution;
  const RowBuilder rows(mesh, options);
  const PatchBasis basis(mesh);
  InterpolatedView view(mesh, basis, rows.scene().scale, resolution, true, eye_of_corner, radiosity,
                        3);
  Hemicube hemicube = rows.makeHemicube();
  std::vector<std::uint8_t> hidden;
  const Vec3 up(0, 0, 1);
  view.begin(eyeFrame(eye * rows.scene().scale, up, 0.3));
  rows.lookFrom(eye, up, 0.3, kNone, hemicube, hidden, &view);
  std::array<double, 3> irradiance{};
  view.irradiance(irradiance);
  return irradiance[0];
}

TEST(Interpolation, LinearFieldsLookTheSameHoweverTheyAreCut) {
  // A ceiling at height 1 with B = 2 + x - 3y, integrated over the square against the kernel
  // 1 / (pi r^4) by 400 x 400 midpoints (error 1e-6); the hemicube's own pixels err by 2e-4 here.
  const auto field = [](const Vec3& p) { return 2 + p.x - 3 * p.y; };
  const Vec3 eye(0.3, 0.2, 0);
  double truth = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vec3 p(-0.5 + (i + 0.5) / n, -0.5 + (j + 0.5) / n, 1);
      const double r2 = glm::dot(p - eye, p - eye);
      truth += field(p) / (std::numbers::pi * r2 * r2 * n * n);
    }
  }
  const auto square = [](double x0, double x1, double y0, double y1) {
    return MeshBuilder::Loop{{x0, y0, 1}, {x0, y1, 1}, {x1, y1, 1}, {x1, y0, 1}};
  };
  const MeshBuilder::Loop whole = square(-0.5, 0.5, -0.5, 0.5);
  const Vec3 inner(0.1, -0.2, 1);
  std::vector<MeshBuilder> cuts(4);
  cuts[0].polygon("ceiling", {whole});
  cuts[1].polygon("ceiling", {whole},
                  {{whole[0], whole[1], whole[2]}, {whole[0], whole[2], whole[3]}});
  cuts[2].polygon("ceiling", {whole},  // quadrilaterals that are no parallelograms
                  {{whole[0], whole[1], {0, 0.5, 1}, {0.2, -0.5, 1}},
                   {{0.2, -0.5, 1}, {0, 0.5, 1}, whole[2], whole[3]}});
  cuts[3].polygon("ceiling", {whole},
                  {{whole[0], whole[1], inner},
                   {whole[1], whole[2], inner},
                   {whole[2], whole[3], inner},
                   {whole[3], whole[0], inner}});
  const double first = irradianceOf(cuts[0].build(), eye, 256, field);
  EXPECT_NEAR(first, truth, 5e-4 * truth);
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    // The same pixels see the same field: only rounding (corner values are floats) may differ.
    EXPECT_NEAR(irradianceOf(cuts[k].build(), eye, 256, field), first, 1e-6 * truth) << k;
  }
}

TEST(Interpolation, WeightsOfAPatchAddUpToItsArea) {
  for (const char* scene : {"cornell-box", "curved", "cluttered"}) {
    const Room room = test::loadRoom(scene, 200);
    const std::vector<double> weights = PatchBasis(room.mesh).areaWeights();
    for (std::size_t i = 0; i < room.mesh.size(); ++i) {
      double sum = 0;
      Vec3 moment(0.0);
      for (std::size_t c = room.mesh.corner_offset[i]; c < room.mesh.corner_offset[i + 1]; ++c) {
        EXPECT_GT(weights[c], 0.0);
        sum += weights[c];
        moment += weights[c] * room.mesh.vertices[room.mesh.corners[c]];
      }
      EXPECT_NEAR(sum, room.mesh.area[i], 1e-9 * room.mesh.area[i]);
      // Linear precision: the weighted corners balance at the centroid (four-point quadrature of a
      // rational weight leaves 1e-3 of the size of a crooked quadrilateral).
      EXPECT_LT(glm::distance(moment / sum, room.mesh.centroid[i]),
                1e-3 * std::sqrt(room.mesh.area[i]))
          << scene << " " << i;
    }
  }
}

TEST(GatherAtVertices, ThreadsScaleAndNumberingChangeNoBit) {
  const MeshBuilder builder = test::roomWithBlock(2);
  Room room{builder.build(), {}};
  test::makeUniform(room, 0.6, 0.0);
  test::setRgb(room.materials.emission, 3, {1, 2, 3});
  const Gathered reference = test::gathered(room, atVertices(4, 32));

  setThreads(1);
  const Gathered alone = test::gathered(room, atVertices(4, 32));
  setThreads(0);
  EXPECT_EQ(alone.radiosity, reference.radiosity);

  GatherOptions scalar = atVertices(4, 32);
  scalar.simd = false;
  EXPECT_EQ(test::gathered(room, scalar).radiosity, reference.radiosity);

  Room large = room;
  for (Vec3& v : large.mesh.vertices) v *= 1024.0;
  for (Vec3& v : large.mesh.centroid) v *= 1024.0;
  for (Vec3& v : large.mesh.polygons.origin) v *= 1024.0;
  for (double& a : large.mesh.area) a *= 1024.0 * 1024.0;
  EXPECT_EQ(test::gathered(large, atVertices(4, 32)).radiosity, reference.radiosity);

  std::vector<std::size_t> order(room.mesh.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::reverse(order.begin(), order.end());
  Room turned{builder.build(order), room.materials};
  test::setRgb(turned.materials.emission, 3, Vec3(0));
  test::setRgb(turned.materials.emission, room.mesh.size() - 1 - 3, {1, 2, 3});
  const Gathered permuted = test::gathered(turned, atVertices(4, 32));
  const std::vector<double> a = cornerRadiosity(room.mesh, reference);
  const std::vector<double> b = cornerRadiosity(turned.mesh, permuted);
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t k = 0; k < 12; ++k) ASSERT_EQ(a[12 * order[i] + k], b[12 * i + k]) << i;
  }
}

}  // namespace
}  // namespace radiosity
