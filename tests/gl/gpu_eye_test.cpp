// Hemicubes drawn by OpenGL beside those of the CPU's eye: the same pixels, the same rows.
#include "formfactor/hemicube/gpu_eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>

#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/gpu_scene.h"
#include "formfactor/hemicube/row_builder.h"
#include "gl/software_renderer.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

/// Of pixels whose polygon both must agree on.
constexpr double kSame = 0.999;

/// `name`: in data/, or a path.
PatchMesh meshOf(const std::filesystem::path& name, std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  Progress silent;
  const std::filesystem::path data = RADIOSITY_SOURCE_DIR "/data";
  return meshScene(loadScene((data / name).string()), options, silent).mesh;
}

FormFactorOptions ofResolution(int resolution) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  options.precision = Precision::double_precision;
  return options;
}

/// Both eyes on one mesh.
class BothEyes {
 public:
  BothEyes(const PatchMesh& mesh, int resolution)
      : rows_(mesh, ofResolution(resolution)),
        cpu_(rows_.makeHemicube()),
        gpu_(openGpuEye(EyeChoice::gl, rows_.scene(), mesh, rows_.weights())) {}

  /// Differences of all hemicubes together.
  struct Difference {
    std::size_t pixels = 0;
    std::size_t polygon = 0;   ///< pixels that show another polygon
    double weight = 0;         ///< of these, of the hemicube where it is most
    double row = 0;            ///< sum of |differences| of a row less 2 `weight`, where it is most
    double largest_sky = 0;    ///< by the GPU
    double largest_error = 0;  ///< of a row's sum
    std::set<Index> polygons;  ///< that the processor shows
  };

  Difference compare(const std::vector<PlacedEye>& eyes, const std::vector<std::uint8_t>& hidden) {
    Difference all;
    for (const PlacedEye& eye : eyes) compareOne(eye, hidden, all);
    return all;
  }

  /// From `count` patches.
  Difference compareAtPatches(const PatchMesh& mesh, std::size_t count) {
    Difference all;
    std::vector<std::uint8_t> hidden;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t patch = (2 * k + 1) * mesh.size() / (2 * count);
      if (rows_.isEmpty(patch)) continue;
      const PlacedEye eye = rows_.eyeOf(patch, hidden);
      compareOne(eye, hidden, all);
    }
    return all;
  }

  const RowBuilder& rows() const { return rows_; }
  GpuEye& gpu() { return *gpu_; }

 private:
  void compareOne(const PlacedEye& eye, const std::vector<std::uint8_t>& hidden, Difference& all) {
    const auto describe = [&](std::size_t, GpuView& view, std::span<std::uint32_t> words) {
      describeEye(eye, hidden, view, words);
    };
    const HemicubeView& expected =
        cpu_.look(eye.frame, eye.own, hidden.empty() ? nullptr : hidden.data());
    const double weight = comparePictures(gpu_->pictures(describe), all);
    GpuRowReader reader;
    const std::string problem = gpu_->look(1, describe, [&](const GpuRows& rows) {
      const HemicubeView& seen = reader.read(rows, 0, rows_.scene().patches);
      double row = std::abs(seen.sky - expected.sky);
      for (std::size_t k = 0; k < seen.items.size(); ++k) {
        row += std::abs(seen.items[k] - expected.items[k]);
      }
      all.row = std::max(all.row, row - 2 * weight);
      all.weight = std::max(all.weight, weight);
      all.largest_sky = std::max(all.largest_sky, seen.sky);
      const double error = std::abs(seen.fronts + seen.backs + seen.sky - 1);
      all.largest_error = std::max(all.largest_error, error);
      return true;
    });
    EXPECT_EQ(problem, "");
  }

  /// The weight of pixels that differ.
  double comparePictures(const std::vector<Index>& seen, Difference& all) {
    const DeltaFormFactors& weights = rows_.weights();
    std::size_t at = 0;
    double weight = 0;
    for (int face = 0; face < kFaces; ++face) {
      const std::vector<Index> expected = cpu_.picture(face);
      all.polygons.insert(expected.begin(), expected.end());
      for (std::size_t k = 0; k < expected.size(); ++k, ++at) {
        if (seen.at(at) == expected[k]) continue;
        const auto resolution = std::size_t(weights.resolution());
        const int y = int(k / resolution);
        const double* sums = face == 0 ? weights.topRow(y) : weights.sideRow(y);
        weight += sums[k % resolution + 1] - sums[k % resolution];
        ++all.polygon;
      }
      all.pixels += expected.size();
    }
    return weight;
  }

  RowBuilder rows_;
  Hemicube cpu_;
  std::unique_ptr<GpuEye> gpu_;
};

/// At most kSame of pixels differ, rows are as far apart as these weigh and sum to 1: weights are
/// whole numbers of 2^-62, of which a row has up to 3 * 128^2, and sums of items round anew.
void expectSame(const BothEyes::Difference& difference) {
  EXPECT_LE(double(difference.polygon), (1 - kSame) * double(difference.pixels));
  EXPECT_LE(difference.row, 1e-13);
  EXPECT_LE(difference.largest_error, 1e-13);
}

TEST(GpuEye, ShowsTheProcessorsPixelsInAClosedRoom) {
  // The vertices of the block lie in the middle of no edge: no pixel is lost between polygons.
  const PatchMesh mesh = test::roomWithBlock(3).build();
  BothEyes both(mesh, 64);
  const BothEyes::Difference difference = both.compareAtPatches(mesh, 12);
  expectSame(difference);
  EXPECT_EQ(difference.largest_sky, 0);
}

TEST(GpuEye, ShowsTheProcessorsPixelsInScenesOfFiles) {
  // Faces in one plane are put together: vertices of others lie on their edges. Meshes have cells
  // that patches share.
  for (const char* name :
       {"cornell-box-closed.obj", "two-rooms.obj", "cluttered.obj", "blender-room.glb"}) {
    const PatchMesh mesh = meshOf(name, 300);
    BothEyes both(mesh, 96);
    const BothEyes::Difference difference = both.compareAtPatches(mesh, 6);
    expectSame(difference);
    const bool closed =
        name == std::string("cornell-box-closed.obj") || name == std::string("two-rooms.obj");
    EXPECT_LE(difference.largest_sky, closed ? 0 : 1) << name;
  }
}

TEST(GpuEye, CutsATriangleOnceAtAVertexBesideItsCorner) {
  // Beside an obtuse corner, a bit more than coincidence away, lies a corner of another triangle.
  // The cut from it passes by the obtuse one at less than coincidence: there it must not be cut
  // again, or the old triangle would come out.
  const double coincidence = 2e-7;  // MeshOptions::weld of the diagonal
  MeshBuilder builder;
  builder.polygon("triangle", {{{0, 0, 0}, {1, 0, 0}, {-0.5, std::sqrt(0.75), 0}}});
  builder.polygon("upright", {{{1.1 * coincidence, 0, 0}, {0, 0.5, 1}, {0, 0, 1}}});
  const PatchMesh mesh = builder.build();
  const RowBuilder rows(mesh, ofResolution(16));
  const GpuScene scene(rows.scene(), mesh);
  EXPECT_NEAR(scene.coincidence / glm::distance(scene.vertices[0], scene.vertices[1]), coincidence,
              1e-12);
  EXPECT_EQ(scene.triangles.size(), 3U);  // the upright one, and two parts of the other
}

TEST(GpuEye, ShowsTheProcessorsPixelsInAModelOfOthers) {
  // An engine of many small curved parts, of Debian's package of models for Assimp's tests: most
  // polygons are a few pixels wide.
  const PatchMesh mesh =
      meshOf("/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 300);
  BothEyes both(mesh, 96);
  expectSame(both.compareAtPatches(mesh, 3));
}

TEST(GpuEye, ShowsTheProcessorsPixelsInAnOpenScene) {
  const PatchMesh mesh = meshOf("cornell-box.obj", 100);
  BothEyes both(mesh, 34);  // the last group of a row of pixels is not full
  const BothEyes::Difference difference = both.compareAtPatches(mesh, 10);
  expectSame(difference);
  EXPECT_GT(difference.largest_sky, 0.1);
}

/// Plates of `size` at random, each a polygon, above a floor.
PatchMesh platesAboveAFloor(int count, double size, unsigned seed) {
  MeshBuilder builder;
  builder.grid("floor", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 2);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto direction = [&] {
    return glm::normalize(Vec3(unit(random), unit(random), unit(random)) - 0.5);
  };
  for (int k = 0; k < count; ++k) {
    const Vec3 at(unit(random), unit(random), 0.2 + unit(random));
    const Vec3 u = direction();
    builder.grid("plates", at, size * u, size * glm::normalize(glm::cross(u, direction())), 1, 1,
                 true);
  }
  return builder.build();
}

TEST(GpuEye, DrawsPolygonsSmallerThanAPixel) {
  // A pixel of the top face is 1/16 wide at distance 1; plates are a fourth of that. Most are
  // missed by all pixel centres, and those that are not are seen in one pixel, mostly.
  const PatchMesh mesh = platesAboveAFloor(400, 1.0 / 64, 5);
  BothEyes both(mesh, 32);
  const BothEyes::Difference difference = both.compareAtPatches(mesh, 12);
  expectSame(difference);
  EXPECT_GT(difference.polygons.size(), 100u);
}

TEST(GpuEye, DrawsPolygonsThroughTheEyesPlane) {
  // Walls cut by the eye's plane, one through the eye itself, seen edge-on, and one in the eye's
  // own plane.
  MeshBuilder builder;
  builder.grid("floor", {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  builder.grid("beside", {2, -1, 0}, {1, 0, 0}, {0, 1, 0});
  builder.grid("wall", {0.5, -1, -1}, {0, 2, 0}, {0, 0, 2}, 3, 3, true);
  builder.grid("tilted", {-0.8, -1, -0.5}, {0, 2, 0.25}, {-0.5, 0, 1.5}, 2, 2, true);
  builder.grid("edge-on", {0, 0, 0.25}, {0, 1, 0}, {0, 0, 1}, 2, 2, true);
  const PatchMesh mesh = builder.build();
  BothEyes both(mesh, 64);
  std::vector<std::uint8_t> hidden;
  std::vector<PlacedEye> eyes;
  for (const double angle : {0.1, 0.9, 2.3, 4.0}) {
    eyes.push_back(both.rows().place({0, 0, 0}, {0, 0, 1}, angle, 0, hidden));
  }
  const BothEyes::Difference difference = both.compare(eyes, hidden);
  expectSame(difference);
  EXPECT_GT(difference.largest_sky, 0.1);
}

/// An eye that works at its device's pace, or at another.
std::unique_ptr<GpuEye> eyeOf(const GpuScene& scene, const RowBuilder& rows,
                              std::optional<GpuPace> pace = std::nullopt) {
  std::string problem;
  auto gpu = gpuEyes().open(0, scene, GpuWeights(rows.weights()), pace, problem);
  EXPECT_NE(gpu, nullptr) << problem;
  return gpu;
}

/// Pace of batches of `views`.
GpuPace batchesOf(std::size_t views, std::size_t ring, int resolution) {
  return {ring, views * 3 * std::size_t(resolution) * std::size_t(resolution)};
}

TEST(GpuEye, MakesRoomForTrianglesOnManyFaces) {
  // 300 triangles, far larger than the space they lie in: clipping makes more than six of each, and
  // there is room for fewer than three at first. They cross each other everywhere; depths are
  // the processor's, so that no more than a pixel, which weighs 0.005, changes hands in a row.
  const PatchMesh mesh = platesAboveAFloor(150, 8, 3);
  const RowBuilder rows(mesh, ofResolution(16));
  const auto gpu = eyeOf(GpuScene(rows.scene(), mesh), rows, batchesOf(32, 3, 16));
  Hemicube cpu = rows.makeHemicube();
  const std::size_t bytes = gpu->bytes();
  Progress silent;
  std::vector<Index> patches(100);  // more batches than are under way at once
  std::iota(patches.begin(), patches.end(), Index(0));
  std::vector<std::vector<double>> items(patches.size());
  const std::string problem = lookFromPatches(
      *gpu, rows, patches,
      [&](std::size_t patch, const HemicubeView& view, const HemicubeReport&) {
        items[patch].assign(view.items.begin(), view.items.end());
      },
      silent);
  EXPECT_EQ(problem, "");
  EXPECT_NE(gpu->bytes(), bytes);
  std::vector<std::uint8_t> hidden;
  for (const Index patch : patches) {
    const HemicubeView& expected = rows.look(patch, cpu, hidden);
    ASSERT_EQ(items[patch].size(), expected.items.size());
    double difference = 0;
    for (std::size_t k = 0; k < items[patch].size(); ++k) {
      difference += std::abs(items[patch][k] - expected.items[k]);
    }
    EXPECT_LE(difference, 0.01);
  }
}

TEST(GpuEye, CutsTrianglesAtVerticesOnTheirEdges) {
  // The wall's lower edge has a vertex of the floor's in its middle, which two quadrilaterals
  // share.
  MeshBuilder builder;
  builder.grid("left", {0, 0, 0}, {0.3, 0, 0}, {0, 1, 0});
  builder.grid("right", {0.3, 0, 0}, {0.7, 0, 0}, {0, 1, 0});
  builder.grid("wall", {0, 1, 0}, {1, 0, 0}, {0, 0, 1});
  const PatchMesh mesh = builder.build();
  const GpuScene scene(ViewScene(mesh), mesh);
  // Two triangles each, and one more where the wall's edge is cut: an edge of 1 and none of .3 +
  // .7.
  EXPECT_EQ(scene.triangles.size(), 7u);
  for (const GpuTriangle& triangle : scene.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = scene.vertices[triangle[k]];
      const Vec3 b = scene.vertices[triangle[(k + 1) % 3]];
      for (const Vec3& v : scene.vertices) {
        const double along = glm::dot(v - a, b - a) / glm::dot(b - a, b - a);
        const bool between = along > 1e-9 && along < 1 - 1e-9;
        EXPECT_FALSE(between && glm::distance(v, a + along * (b - a)) < 1e-9);
      }
    }
  }
}

TEST(GpuEye, CountsItemsBeyondSinglePrecision) {
  // Whole numbers above 2^24 are not all floats: the last patch of 2^24 + 5 is told from its
  // neighbours. The scene has one wall; its number alone is that high.
  constexpr std::int32_t kLast = (1 << 24) + 4;
  MeshBuilder builder;
  builder.grid("floor", {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  builder.grid("wall", {1, -1, 0}, {0, 0, 1}, {0, 2, 0}, 1, 1, true);
  const PatchMesh mesh = builder.build();
  const RowBuilder rows(mesh, ofResolution(16));
  GpuScene scene(rows.scene(), mesh);
  for (GpuPolygon& polygon : scene.polygons) {
    if (polygon.normal[2] == 0) polygon.item = {kLast, kLast};
  }
  scene.items = kLast + 1;
  const auto gpu = eyeOf(scene, rows);
  ASSERT_NE(gpu, nullptr);
  std::vector<std::uint8_t> hidden;
  const PlacedEye eye = rows.eyeOf(0, hidden);
  const auto describe = [&](std::size_t, GpuView& view, std::span<std::uint32_t> words) {
    describeEye(eye, hidden, view, words);
  };
  Hemicube cpu = rows.makeHemicube();
  const HemicubeView& expected = cpu.look(eye.frame, eye.own, hidden.data());
  const std::string problem = gpu->look(1, describe, [&](const GpuRows& seen) {
    const double wall = kGpuUnit * double(seen.weight(kLast));
    const double sky = kGpuUnit * double(seen.weight(kLast + 1));
    EXPECT_GT(wall, 0.1);
    EXPECT_NEAR(sky, expected.sky, 1e-13);
    EXPECT_NEAR(wall + sky, 1, 1e-13);
    EXPECT_EQ(seen.weight(kLast - 1), 0u);
    return true;
  });
  EXPECT_EQ(problem, "");
}

/// Rows of the first `count` patches, weight by weight.
std::vector<std::vector<std::uint64_t>> rowsSeen(GpuEye& gpu, const RowBuilder& rows,
                                                 std::size_t count) {
  std::vector<std::uint8_t> hidden;
  std::vector<std::vector<std::uint64_t>> all;
  const auto describe = [&](std::size_t k, GpuView& view, std::span<std::uint32_t> words) {
    const PlacedEye eye = rows.eyeOf(k, hidden);
    describeEye(eye, hidden, view, words);
  };
  const std::string problem = gpu.look(count, describe, [&](const GpuRows& seen) {
    const std::size_t weights = seen.low.size() / seen.count;
    EXPECT_EQ(seen.first, all.size());
    for (std::size_t k = 0; k < seen.low.size(); ++k) {
      if (k % weights == 0) all.emplace_back();
      all.back().push_back(seen.weight(k));
    }
    return true;
  });
  EXPECT_EQ(problem, "");
  EXPECT_EQ(all.size(), count);
  return all;
}

TEST(GpuEye, RowsHaveTheSameBitsInAnyBatches) {
  // A few at once, three batches under way, or all at once, across a target of thousands of pixels.
  // Plates cross each other and lie in each other's planes, so that the smallest difference of a
  // depth changes pixels; in the box that of an edge does.
  constexpr int kResolution = 32;
  constexpr std::size_t kEyes = 600;
  for (const PatchMesh& mesh : {meshOf("cornell-box.obj", 600), platesAboveAFloor(300, 0.5, 7)}) {
    const RowBuilder rows(mesh, ofResolution(kResolution));
    const GpuScene scene(rows.scene(), mesh);
    const auto few = rowsSeen(*eyeOf(scene, rows, batchesOf(7, 3, kResolution)), rows, kEyes);
    const auto all = rowsSeen(*eyeOf(scene, rows, batchesOf(kEyes, 1, kResolution)), rows, kEyes);
    std::size_t differ = 0;
    for (std::size_t k = 0; k < kEyes; ++k) differ += few[k] != all[k] ? 1 : 0;
    EXPECT_EQ(differ, 0u);
  }
}

/// Irradiance at all patches, in passes: each emits 1, and reflects half of its light from the pass
/// before.
std::vector<double> lightGathered(GpuEye& gpu, const RowBuilder& rows, std::size_t patches,
                                  int passes) {
  GpuField field;
  field.bands = 1;
  field.eyes = field.patches = patches;
  field.emission.assign(patches, 1);
  field.reflectance.assign(patches, 0.5F);
  field.sky = {0};
  EXPECT_EQ(gpu.prepare(field), "");
  std::vector<std::uint8_t> hidden;
  std::vector<double> light;
  for (int pass = 0; pass < passes; ++pass) {
    light.clear();
    const auto describe = [&](std::size_t k, GpuView& view, std::span<std::uint32_t> words) {
      const PlacedEye eye = rows.eyeOf(k, hidden);
      describeEye(eye, hidden, view, words);
      view.source = std::uint32_t(k);
    };
    const std::string problem = gpu.gather(patches, describe, [&](const GpuRows& seen) {
      light.insert(light.end(), seen.irradiance.begin(), seen.irradiance.end());
      return true;
    });
    EXPECT_EQ(problem, "");
  }
  return light;
}

TEST(GpuEye, GathersTheSameLightInAnyBatches) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  const RowBuilder rows(mesh, ofResolution(32));
  const GpuScene scene(rows.scene(), mesh);
  const std::size_t n = mesh.size();
  const auto few = lightGathered(*eyeOf(scene, rows, batchesOf(5, 3, 32)), rows, n, 3);
  const auto all = lightGathered(*eyeOf(scene, rows, batchesOf(n, 1, 32)), rows, n, 3);
  EXPECT_EQ(few, all);
  // The room is closed: 1 + 1/2 + 1/4.
  for (const double irradiance : few) EXPECT_NEAR(irradiance, 1.75, 1e-6);
}

TEST(GpuEye, RefusesASceneThatTheDeviceCannotHold) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const RowBuilder rows(mesh, ofResolution(16));
  GpuScene scene(rows.scene(), mesh);
  scene.items = 1U << 31;  // a row of 8 GiB
  std::string problem;
  EXPECT_EQ(gpuEyes().open(0, scene, GpuWeights(rows.weights()), std::nullopt, problem), nullptr);
  EXPECT_EQ(problem, "the scene is too large for the buffers of the device");
}

TEST(GpuEye, GivesUpForGoodIfLightDoesNotFit) {
  // Sums of 128 pixels take 1,536 numbers a band and hemicube: 6 GiB.
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const RowBuilder rows(mesh, ofResolution(256));
  const auto gpu = eyeOf(GpuScene(rows.scene(), mesh), rows);
  GpuField field;
  field.bands = std::size_t(1) << 19;
  field.eyes = 1;
  field.patches = mesh.size();
  field.emission.assign(field.bands, 1);
  field.reflectance.assign(field.bands, 0);
  field.sky.assign(field.bands, 0);
  field.first_facet.assign(mesh.size() + 1, 0);
  const std::string problem = gpu->prepare(field);
  EXPECT_EQ(problem, "the scene is too large for the buffers of the device");
  const auto describe = [](std::size_t, GpuView&, std::span<std::uint32_t>) {};
  const auto take = [](const GpuRows&) { return true; };
  EXPECT_EQ(gpu->look(1, describe, take), problem);
  EXPECT_EQ(gpu->gather(1, describe, take), problem);
  EXPECT_THROW(gpu->pictures(describe), RunError);
}

TEST(GpuDevices, SoftwareRenderersAreRecognisedByName) {
  for (const char* name :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "SWR (LLVM 12.0.0)",
        "zink Vulkan 1.3(llvmpipe (LLVM 17.0.6, 256 bits) (MESA_LLVMPIPE))", "zink (Lavapipe)"}) {
    EXPECT_TRUE(gl::isSoftwareRenderer(name)) << name;
  }
  for (const char* name : {"NVIDIA H100 PCIe/PCIe/SSE2", "AMD Radeon RX 6800 (radeonsi, navi21)",
                           "Mesa Intel(R) UHD Graphics 620 (KBL GT2)",
                           "zink Vulkan 1.3(NVIDIA GeForce RTX 3060 (NVK_AMPERE))"}) {
    EXPECT_FALSE(gl::isSoftwareRenderer(name)) << name;
  }
}

TEST(GpuEye, FormFactorsEqualTheProcessorsWithinAFewPixels) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  Progress silent;
  FormFactorOptions options = ofResolution(64);
  const FormFactors cpu = computeFormFactors(mesh, options, silent);
  options.eye = EyeChoice::gl;
  const FormFactors gl = computeFormFactors(mesh, options, silent);
  EXPECT_TRUE(gl.report.closed);
  EXPECT_LE(gl.report.largest_row_error, 1e-12);
  EXPECT_EQ(gl.report.hemicube.hemicubes, cpu.report.hemicube.hemicubes);
  EXPECT_EQ(gl.report.hemicube.pixels, cpu.report.hemicube.pixels);
  EXPECT_EQ(gl.report.hemicube.skipped_own_plane, cpu.report.hemicube.skipped_own_plane);
  EXPECT_EQ(gl.report.hemicube.skipped_horizon, cpu.report.hemicube.skipped_horizon);
  EXPECT_EQ(gl.report.hemicube.skipped_facing_away, cpu.report.hemicube.skipped_facing_away);
  EXPECT_EQ(gl.report.hemicube.skipped_face, cpu.report.hemicube.skipped_face);
  EXPECT_EQ(gl.report.hemicube.rasterised_polygons, cpu.report.hemicube.rasterised_polygons);
  double row =
      0;  // two pixels of the top face's middle, 3e-4 each, change hands in a row, not more
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      sum += std::abs(gl.matrix->at(i, j) - cpu.matrix->at(i, j));
    }
    row = std::max(row, sum);
  }
  EXPECT_LE(row, 4 * 3.2e-4);
}

}  // namespace
}  // namespace radiosity
