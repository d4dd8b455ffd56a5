// Form factors and gathered light if a GPU gives up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "formfactor/hemicube/gpu_rows.h"
#include "formfactor/hemicube/hemicube_factors.h"
#include "formfactor/shared_factors.h"
#include "gather/passes.h"
#include "support/mesh_builder.h"

namespace radiosity {
namespace {

/// Works as the processor's eye for some views, two at a time, then reports that it is lost.
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
  /// Of patches, which have one radiosity each.
  std::string prepare(const GpuField& field) override {
    field_ = field;
    return {};
  }
  /// The emission of patches, as in a first pass.
  std::string gather(std::size_t count, const Describe& describe, const Take& take) override {
    return look(count, describe, take);
  }
  std::vector<Index> pictures(const Describe& /*describe*/) override { return {}; }
  std::size_t bytes() const override { return 0; }
  const EyeDevice& device() const override { return about_; }

 private:
  GpuRows rowsOf(std::size_t first, std::size_t count, const Describe& describe) {
    low_.clear();
    high_.clear();
    irradiance_.clear();
    Hemicube hemicube = rows_.makeHemicube();
    for (std::size_t k = 0; k < count; ++k) {
      GpuView view{};
      std::vector<std::uint32_t> words((rows_.scene().polygons.size() + 31) / 32, 0);
      describe(first + k, view, words);
      add(hemicube.look(frameOf(view), view.own, nullptr));
    }
    return {first, count, low_, high_, {}, irradiance_};
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
    for (std::size_t band = 0; band < field_.bands; ++band) {
      double& sum = irradiance_.emplace_back(0);
      for (std::size_t j = 0; j < field_.patches; ++j) {
        sum += seen.items[j] * double(field_.emission[field_.bands * j + band]);
      }
    }
  }

  const RowBuilder& rows_;
  std::size_t lives_;
  EyeDevice about_{"failing", "none", true};
  GpuField field_;
  std::vector<std::uint32_t> low_, high_;
  std::vector<double> irradiance_;
};

/// One device, which holds no scene.
class FullEyes final : public GpuEyes {
 public:
  explicit FullEyes(bool hardware) : hardware_(hardware) {}
  EyeDevices devices() const override { return {{{"full", "none", hardware_}}, {}}; }
  std::unique_ptr<GpuEye> open(std::size_t /*d*/, const GpuScene& /*scene*/,
                               const GpuWeights& /*weights*/, std::optional<GpuPace> /*pace*/,
                               std::string& problem) const override {
    problem = "the device has no memory left";
    return nullptr;
  }

 private:
  bool hardware_;
};

/// No device.
class NoEyes final : public GpuEyes {
 public:
  EyeDevices devices() const override { return {{}, "there is no device: install a driver"}; }
  std::unique_ptr<GpuEye> open(std::size_t /*d*/, const GpuScene& /*scene*/,
                               const GpuWeights& /*weights*/, std::optional<GpuPace> /*pace*/,
                               std::string& /*problem*/) const override {
    return nullptr;
  }
};

FormFactorOptions smallHemicubes() {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = 32;
  options.precision = Precision::double_precision;
  return options;
}

bool has(const std::vector<Note>& notes, Severity severity, const std::string& words) {
  return std::ranges::any_of(notes, [&](const Note& note) {
    return note.severity == severity && note.text.find(words) != std::string::npos;
  });
}

TEST(GpuFallback, TheProcessorDrawsTheRestOfALostDevice) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const FormFactorOptions options = smallHemicubes();
  Progress silent;
  const FormFactors expected = computeFormFactors(mesh, options, silent);
  for (const std::size_t lives : {0, 4, 100}) {
    HemicubeScene scene(mesh, options);
    scene.gpu = std::make_unique<FailingEye>(scene.rows, lives);
    const FormFactors seen = hemicubeFactors(mesh, scene, {}, options, {silent});
    EXPECT_EQ(seen.report.hemicube.hemicubes, expected.report.hemicube.hemicubes);
    EXPECT_EQ(seen.report.hemicube.pixels, expected.report.hemicube.pixels);
    EXPECT_TRUE(seen.report.closed);
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      for (std::size_t j = 0; j < mesh.size(); ++j) {
        // Whole numbers of 2^-62 are doubles' roundings below a weight of 1.
        EXPECT_NEAR(seen.matrix->at(i, j), expected.matrix->at(i, j), 1e-15);
      }
    }
    const std::vector<Note>& notes = seen.report.notes;
    EXPECT_EQ(has(notes, Severity::warning, "failing: the device was lost"), lives < mesh.size());
    EXPECT_EQ(has(notes, Severity::info, "hemicubes drawn by failing"), lives > 0);
  }
}

TEST(GpuFallback, MemoryIsForecastIfTheDeviceIsLost) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  Progress silent;
  HemicubeScene scene(mesh, smallHemicubes());
  const HemicubeEstimate expected = estimateHemicubes(mesh, scene, smallHemicubes(), silent);
  scene.gpu = std::make_unique<FailingEye>(scene.rows, 0);
  const HemicubeEstimate estimate = estimateHemicubes(mesh, scene, smallHemicubes(), silent);
  EXPECT_EQ(estimate.matrix_bytes, expected.matrix_bytes);
}

/// A room whose first patch shines.
PatchMaterials lampAndWalls(const PatchMesh& mesh) {
  PatchMaterials materials;
  materials.bands = 2;
  materials.reflectance.assign(2 * mesh.size(), 0.5);
  materials.emission.assign(2 * mesh.size(), 0);
  materials.emission[0] = 10;
  materials.emission[1] = 20;
  return materials;
}

TEST(GpuFallback, TheProcessorGathersTheRestOfALostDevice) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const PatchMaterials materials = lampAndWalls(mesh);
  GatherOptions options;
  options.at = GatherAt::patches;
  options.resolution = 32;
  options.passes = 4;
  Progress silent;
  const Gathered expected = gather(mesh, materials, options, silent);
  const GatherScene scene(mesh, materials, options, silent);
  for (const std::size_t lives : {0, 4}) {
    auto eye = std::make_unique<FailingEye>(scene.rows, lives);
    const Gathered seen = gatherIn(scene, std::move(eye), options, silent);
    EXPECT_EQ(seen.summary.hemicubes, expected.summary.hemicubes);
    ASSERT_EQ(seen.radiosity.size(), expected.radiosity.size());
    for (std::size_t k = 0; k < seen.radiosity.size(); ++k) {
      EXPECT_NEAR(seen.radiosity[k], expected.radiosity[k], 1e-5);
    }
    const std::vector<Note>& notes = seen.summary.notes;
    EXPECT_TRUE(has(notes, Severity::warning, "failing: the device was lost"));
    EXPECT_EQ(has(notes, Severity::info, "hemicubes drawn by failing"), lives > 0);
  }
}

TEST(GpuFallback, TheProcessorDrawsASceneThatTheDeviceCannotHold) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  Progress silent;
  const FormFactors expected = computeFormFactors(mesh, smallHemicubes(), silent);
  for (const EyeChoice choice : {EyeChoice::gl, EyeChoice::automatic}) {
    HemicubeScene scene(mesh, smallHemicubes());
    scene.gpu = openGpuEye(choice, scene.rows.scene(), mesh, scene.rows.weights(), FullEyes(true));
    const FormFactors seen = hemicubeFactors(mesh, scene, {}, smallHemicubes(), {silent});
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      EXPECT_EQ(seen.matrix->at(0, i), expected.matrix->at(0, i));
    }
    const std::vector<Note>& notes = seen.report.notes;
    EXPECT_TRUE(has(notes, Severity::warning, "full: the device has no memory left; all "));
    EXPECT_FALSE(has(notes, Severity::info, "drawn by"));
  }
}

TEST(GpuFallback, TheProcessorGathersLightThatTheDeviceCannotHold) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const PatchMaterials materials = lampAndWalls(mesh);
  GatherOptions options;
  options.resolution = 32;
  options.passes = 2;
  Progress silent;
  const Gathered expected = gather(mesh, materials, options, silent);
  const GatherScene scene(mesh, materials, options, silent);
  auto eye =
      openGpuEye(EyeChoice::gl, scene.rows.scene(), mesh, scene.rows.weights(), FullEyes(false));
  const Gathered seen = gatherIn(scene, std::move(eye), options, silent);
  EXPECT_EQ(seen.radiosity, expected.radiosity);
  EXPECT_TRUE(has(seen.summary.notes, Severity::warning, "full: the device has no memory left"));
  EXPECT_FALSE(has(seen.summary.notes, Severity::info, "drawn by"));
}

TEST(GpuFallback, AMissingDeviceIsAnErrorOnlyOnRequest) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const RowBuilder rows(mesh, smallHemicubes());
  const auto open = [&](EyeChoice choice, const GpuEyes& eyes) {
    return openGpuEye(choice, rows.scene(), mesh, rows.weights(), eyes);
  };
  try {
    open(EyeChoice::gl, NoEyes());
    FAIL();
  } catch (const RunError& error) {
    EXPECT_STREQ(error.what(), "eye gl: there is no device: install a driver; or take the eye cpu");
  }
  EXPECT_EQ(open(EyeChoice::automatic, NoEyes()), nullptr);
  EXPECT_EQ(open(EyeChoice::automatic, FullEyes(false)), nullptr);
  EXPECT_NE(open(EyeChoice::automatic, FullEyes(true)), nullptr);
  EXPECT_EQ(open(EyeChoice::cpu, FullEyes(true)), nullptr);
}

TEST(GpuFallback, AMissingLibraryIsToldFromOneThatDoesNotLoad) {
  const std::string not_found = ": cannot open shared object file: No such file or directory";
  const std::string missing = libraryProblem("libradiosity_gl.so" + not_found);
  EXPECT_NE(missing.find("built without libepoxy-dev"), std::string::npos) << missing;
  const std::string broken = libraryProblem("libepoxy.so.0" + not_found);
  EXPECT_NE(broken.find("install Debian's libepoxy0"), std::string::npos) << broken;
  EXPECT_EQ(broken.find("-dev"), std::string::npos) << broken;
}

TEST(GpuFallback, ProcessesOfOneRunDrawByTheProcessor) {
  const PatchMesh mesh = test::roomWithBlock(1).build();
  const RowBuilder rows(mesh, smallHemicubes());
  setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  const auto eye =
      openGpuEye(EyeChoice::automatic, rows.scene(), mesh, rows.weights(), FullEyes(true));
  unsetenv("OMPI_COMM_WORLD_SIZE");
  EXPECT_EQ(eye, nullptr);
  FormFactorOptions options = smallHemicubes();
  options.eye = EyeChoice::automatic;
  EXPECT_NO_THROW(requireShareable(options));
  options.eye = EyeChoice::gl;
  EXPECT_THROW(requireShareable(options), InputError);
}

}  // namespace
}  // namespace radiosity
