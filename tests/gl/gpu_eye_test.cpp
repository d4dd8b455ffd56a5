// Hemicubes drawn by OpenGL beside those of the CPU's eye: the same pixels, the same rows.
#include "formfactor/hemicube/gpu_eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <random>

#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/gpu_scene.h"
#include "formfactor/hemicube/row_builder.h"
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

  /// What differs, all hemicubes together.
  struct Difference {
    std::size_t pixels = 0;
    std::size_t polygon = 0;   ///< pixels that show another polygon
    double weight = 0;         ///< of these, of the hemicube where it is most
    double row = 0;            ///< sum of |differences| of a row less 2 `weight`, where it is most
    double largest_sky = 0;    ///< by the GPU
    double largest_error = 0;  ///< of a row's sum
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

TEST(GpuEye, SeesWhatTheProcessorSeesInAClosedRoom) {
  // The vertices of the block lie in the middle of no edge: no pixel is lost between polygons.
  const PatchMesh mesh = test::roomWithBlock(3).build();
  BothEyes both(mesh, 64);
  const BothEyes::Difference difference = both.compareAtPatches(mesh, 12);
  expectSame(difference);
  EXPECT_EQ(difference.largest_sky, 0);
}

TEST(GpuEye, SeesWhatTheProcessorSeesInScenesOfFiles) {
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
  // again, or the triangle of before would come out.
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

TEST(GpuEye, SeesWhatTheProcessorSeesInAModelOfOthers) {
  // An engine of many small curved parts, of Debian's package of models for Assimp's tests: patches
  // share unknowns, most polygons are a few pixels wide.
  const PatchMesh mesh =
      meshOf("/usr/share/assimp/models/glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 300);
  BothEyes both(mesh, 96);
  expectSame(both.compareAtPatches(mesh, 3));
}

TEST(GpuEye, SeesWhatTheProcessorSeesInAnOpenScene) {
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
  // missed by all pixel centres, and those that are not are seen in one pixel.
  const PatchMesh mesh = platesAboveAFloor(400, 1.0 / 64, 5);
  BothEyes both(mesh, 32);
  const BothEyes::Difference difference = both.compareAtPatches(mesh, 4);
  // Nearly every pixel is at an edge, which one in 256 of them or so is too close to.
  EXPECT_LE(double(difference.polygon), 0.01 * double(difference.pixels));
  EXPECT_LE(difference.row, 1e-13);
}

TEST(GpuEye, DrawsPolygonsThroughTheEyesPlane) {
  // Walls that the eye's plane cuts, one that passes through the eye itself, seen edge-on, and one
  // in the eye's own plane.
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

TEST(GpuEye, MakesRoomWhereEveryTriangleIsOnManyFaces) {
  // 300 triangles, far larger than what they lie in: clipping makes more than six of each, and
  // there is room for fewer than three at first. They cross each other everywhere, and within
  // depths' rounding of a crossing either may be nearer: a pixel in a hundred at most.
  const PatchMesh mesh = platesAboveAFloor(150, 8, 3);
  const RowBuilder rows(mesh, ofResolution(16));
  const auto gpu = openGpuEye(EyeChoice::gl, rows.scene(), mesh, rows.weights());
  Hemicube cpu = rows.makeHemicube();
  const std::size_t bytes = gpu->bytes();
  Progress silent;
  std::vector<Index> patches(100);  // more than one batch
  std::iota(patches.begin(), patches.end(), Index(0));
  std::vector<std::vector<double>> items(patches.size());
  const std::string problem = lookFromPatches(
      *gpu, rows, patches,
      [&](std::size_t patch, const HemicubeView& view, const HemicubeCounts&) {
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
    EXPECT_LE(difference, 0.02);
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
  std::string problem;
  const auto gpu = gpuEyes(problem)->open(0, scene, GpuWeights(rows.weights()), problem);
  ASSERT_NE(gpu, nullptr) << problem;
  std::vector<std::uint8_t> hidden;
  const PlacedEye eye = rows.eyeOf(0, hidden);
  const auto describe = [&](std::size_t, GpuView& view, std::span<std::uint32_t> words) {
    describeEye(eye, hidden, view, words);
  };
  Hemicube cpu = rows.makeHemicube();
  const HemicubeView& expected = cpu.look(eye.frame, eye.own, hidden.data());
  problem = gpu->look(1, describe, [&](const GpuRows& seen) {
    const double wall = kGpuUnit * double(seen.weight(kLast));
    const double sky = kGpuUnit * double(seen.weight(kLast + 1));
    EXPECT_GT(wall, 0.1);
    EXPECT_NEAR(sky, expected.sky, 1e-13);
    EXPECT_NEAR(wall + sky, 1, 1e-13);
    EXPECT_EQ(seen.weight(kLast - 1), 0u);
    EXPECT_EQ(seen.weight(kLast & ~1), seen.weight(kLast));
    return true;
  });
  EXPECT_EQ(problem, "");
}

TEST(GpuEye, BatchesAndRunsGiveTheSameBits) {
  // 40 eyes of 32 pixels are more than one batch; alone, each is a batch of its own. Plates lie in
  // each other's planes: of equal depths the first polygon stays, whatever order corners come in.
  const PatchMesh mesh = platesAboveAFloor(40, 0.3, 7);
  const RowBuilder rows(mesh, ofResolution(32));
  const auto gpu = openGpuEye(EyeChoice::gl, rows.scene(), mesh, rows.weights());
  std::vector<std::uint8_t> hidden;
  std::vector<std::vector<std::uint64_t>> together;
  const auto lookFrom = [&](std::size_t first, std::size_t count, auto&& take) {
    const auto describe = [&](std::size_t k, GpuView& view, std::span<std::uint32_t> words) {
      const PlacedEye eye = rows.eyeOf(first + k, hidden);
      describeEye(eye, hidden, view, words);
    };
    EXPECT_EQ(gpu->look(count, describe, take), "");
  };
  lookFrom(0, 40, [&](const GpuRows& seen) {
    const std::size_t items = seen.low.size() / seen.count;
    EXPECT_EQ(seen.first, together.size());
    for (std::size_t k = 0; k < seen.count; ++k) {
      std::vector<std::uint64_t>& row = together.emplace_back();
      for (std::size_t item = 0; item < items; ++item) row.push_back(seen.weight(k * items + item));
    }
    return true;
  });
  ASSERT_EQ(together.size(), 40u);
  for (std::size_t k = 0; k < 40; k += 3) {
    lookFrom(k, 1, [&](const GpuRows& seen) {
      for (std::size_t item = 0; item < together[k].size(); ++item) {
        EXPECT_EQ(seen.weight(item), together[k][item]);
      }
      return true;
    });
  }
}

TEST(GpuEye, FormFactorsAreTheProcessorsToWithinAFewPixels) {
  const PatchMesh mesh = test::roomWithBlock(2).build();
  Progress silent;
  FormFactorOptions options = ofResolution(64);
  const FormFactors cpu = computeFormFactors(mesh, options, silent);
  options.eye = EyeChoice::gl;
  const FormFactors gl = computeFormFactors(mesh, options, silent);
  EXPECT_TRUE(gl.report.closed);
  EXPECT_LE(gl.report.largest_row_error, 1e-12);
  EXPECT_EQ(gl.report.hemicubes, cpu.report.hemicubes);
  EXPECT_EQ(gl.report.pixels, cpu.report.pixels);
  EXPECT_EQ(gl.report.skipped_own_plane, cpu.report.skipped_own_plane);
  EXPECT_EQ(gl.report.skipped_horizon, cpu.report.skipped_horizon);
  EXPECT_EQ(gl.report.skipped_facing_away, cpu.report.skipped_facing_away);
  EXPECT_EQ(gl.report.skipped_face, cpu.report.skipped_face);
  EXPECT_EQ(gl.report.rasterised_polygons, cpu.report.rasterised_polygons);
  double row =
      0;  // two pixels of the top face's middle, 3e-4 each, change hands in a row, not more
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < mesh.size(); ++j) {
      sum += std::abs(gl.matrix.at(i, j) - cpu.matrix.at(i, j));
    }
    row = std::max(row, sum);
  }
  EXPECT_LE(row, 4 * 3.2e-4);
}

}  // namespace
}  // namespace radiosity
