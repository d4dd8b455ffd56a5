// Hemicubes drawn by OpenGL beside those of the CPU's eye: the same pixels, the same rows.
#include "formfactor/hemicube/gpu_eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/row_builder.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

using test::MeshBuilder;

/// Of pixels whose polygon both must agree on.
constexpr double kSame = 0.999;

PatchMesh meshOf(const std::string& name, std::size_t patches) {
  MeshOptions options;
  options.patches = patches;
  Progress silent;
  return meshScene(loadScene(RADIOSITY_SOURCE_DIR "/data/" + name + ".obj"), options, silent).mesh;
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

void show(const char* name, const BothEyes::Difference& d) {
  fprintf(stderr, "%s: %zu of %zu differ (%.5f%%), weight %.3g, row %.3g, sky %.3g, error %.3g\n", name,
          d.polygon, d.pixels, 100.0 * double(d.polygon) / double(d.pixels), d.weight, d.row,
          d.largest_sky, d.largest_error);
}

TEST(GpuEye, Explore) {
  {
    const PatchMesh mesh = test::roomWithBlock(3).build();
    BothEyes both(mesh, 64);
    show("room with block", both.compareAtPatches(mesh, 20));
  }
  for (const char* name : {"cornell-box-closed", "cornell-box", "two-rooms", "cluttered", "curved"}) {
    const PatchMesh mesh = meshOf(name, 300);
    for (const int resolution : {32, 128}) {
      BothEyes both(mesh, resolution);
      show(name, both.compareAtPatches(mesh, 20));
    }
  }
}

}  // namespace
}  // namespace radiosity
