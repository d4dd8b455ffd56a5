// What becomes of form factors and gathered light where a GPU gives up.
#include <gtest/gtest.h>

#include <algorithm>

#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

/// Does what the processor's eye does for some views, two at a time, then says that it is lost.
class FailingEye final : public GpuEye {
 public:
  FailingEye(const RowBuilder& rows, std::size_t lives) : rows_(rows), lives_(lives) {}

  std::string look(std::size_t count, const Describe& describe, const Take& take) override {
    constexpr std::size_t kBatch = 2;
    for (std::size_t first = 0; first < count; first += kBatch) {
      if (first >= lives_) return "the device was lost";
      if (!take(rowsOf(first, std::min(kBatch, count - first), describe))) break;
    }
    return {};
  }
  std::string prepare(const GpuField& /*field*/) override { return {}; }
  std::string gather(std::size_t /*count*/, const Describe& /*describe*/,
                     const Take& /*take*/) override {
    return "the device was lost";
  }
  std::vector<Index> pictures(const Describe& /*describe*/) override { return {}; }
  std::size_t bytes() const override { return 0; }
  const EyeDevice& device() const override { return about_; }

 private:
  GpuRows rowsOf(std::size_t first, std::size_t count, const Describe& describe) {
    low_.clear();
    high_.clear();
    Hemicube hemicube = rows_.makeHemicube();
    for (std::size_t k = 0; k < count; ++k) {
      GpuView view{};
      std::vector<std::uint32_t> words((rows_.scene().polygons.size() + 31) / 32, 0);
      describe(first + k, view, words);
      add(hemicube.look(frameOf(view), view.own, nullptr));
    }
    return {first, count, low_, high_, {}, {}};
  }
  static EyeFrame frameOf(const GpuView& view) {
    EyeFrame frame;
    for (std::size_t k = 0; k < 3; ++k) {
      frame.eye[int(k)] = view.eye[k];
      for (std::size_t c = 0; c < 3; ++c) frame.axes[int(c)][int(k)] = view.axes[3 * c + k];
    }
    return frame;
  }
  void add(const HemicubeView& seen) {
    const auto addWeight = [&](double weight) {
      const auto units = std::uint64_t(weight / kGpuUnit);
      low_.push_back(std::uint32_t(units));
      high_.push_back(std::uint32_t(units >> 32));
    };
    for (const double weight : seen.items) addWeight(weight);
    addWeight(seen.sky);
  }

  const RowBuilder& rows_;
  std::size_t lives_;
  EyeDevice about_{"failing", "none", true};
  std::vector<std::uint32_t> low_, high_;
};

TEST(GpuFallback, TheProcessorDrawsWhatALostDeviceHasNot) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 32;
  options.precision = Precision::double_precision;
  Progress silent;
  const FormFactors expected = computeFormFactors(mesh, options, silent);
  for (const std::size_t lives : {0, 4, 100}) {
    HemicubeScene scene(mesh, options);
    scene.gpu = std::make_unique<FailingEye>(scene.rows, lives);
    const FormFactors seen =
        hemicubeFactors(mesh, scene, HemicubeEstimate(), options, silent, nullptr, nullptr);
    EXPECT_EQ(seen.report.hemicubes, expected.report.hemicubes);
    EXPECT_EQ(seen.report.pixels, expected.report.pixels);
    EXPECT_TRUE(seen.report.closed);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t j = 0; j < mesh.size(); ++j) {
        // Whole numbers of 2^-62 are doubles' roundings below a weight of 1.
        EXPECT_NEAR(seen.matrix.at(i, j), expected.matrix.at(i, j), 1e-15);
      }
    }
    const std::vector<Note>& notes = seen.report.notes;
    const bool told = std::any_of(notes.begin(), notes.end(), [](const Note& note) {
      return note.severity == Severity::warning &&
             note.text.find("the device was lost") != std::string::npos;
    });
    EXPECT_EQ(told, lives < mesh.size());
  }
}

}  // namespace
}  // namespace radiosity
