#include "formfactor/hemicube/gpu_eye.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "base/processes.h"
#include "base/side_library.h"

namespace radiosity {

namespace {

constexpr const char* kLibrary = "libradiosity_gl.so";

/// Stands for a library that is not there.
class NoEyes final : public GpuEyes {
 public:
  explicit NoEyes(std::string problem) : problem_(std::move(problem)) {}
  EyeDevices devices() const override { return {{}, problem_}; }
  std::unique_ptr<GpuEye> open(std::size_t /*d*/, const GpuScene& /*scene*/,
                               const GpuWeights& /*weights*/, std::optional<GpuPace> /*pace*/,
                               std::string& problem) const override {
    problem = problem_;
    return nullptr;
  }

 private:
  std::string problem_;
};

const GpuEyes& openLibrary() {
  if (void* entry = entryOf(kLibrary, "radiosityGpuEyes"))
    return *reinterpret_cast<const GpuEyes* (*)()>(entry)();
  static const NoEyes none(libraryProblem(dlerror()));
  return none;
}

/// Stands for a device that is there but cannot draw the scene.
class UnusableEye final : public GpuEye {
 public:
  UnusableEye(EyeDevice about, std::string problem)
      : about_(std::move(about)), problem_(std::move(problem)) {}
  std::string look(std::size_t /*count*/, const Describe& /*describe*/,
                   const Take& /*take*/) override {
    return problem_;
  }
  std::string prepare(const GpuField& /*field*/) override { return problem_; }
  std::string gather(std::size_t /*count*/, const Describe& /*describe*/,
                     const Take& /*take*/) override {
    return problem_;
  }
  std::vector<Index> pictures(const Describe& /*describe*/) override { throw RunError(problem_); }
  std::size_t bytes() const override { return 0; }
  const EyeDevice& device() const override { return about_; }

 private:
  EyeDevice about_;
  std::string problem_;
};

}  // namespace

GpuWeights::GpuWeights(const DeltaFormFactors& weights) : resolution(weights.resolution()) {
  const auto append = [&](const double* row, std::vector<std::uint64_t>& sums) {
    for (int x = 0; x <= resolution; ++x) {
      sums.push_back(std::uint64_t(std::llround(row[x] / kGpuUnit)));
    }
  };
  for (int y = 0; y < resolution / 2; ++y) {
    append(weights.topRow(y), top);
    append(weights.sideRow(y), side);
  }
}

const GpuEyes& gpuEyes() {
  static const GpuEyes& eyes = openLibrary();
  return eyes;
}

std::string libraryProblem(const std::string& loader_words) {
  // The loader's words begin with the file that it does not find.
  if (loader_words.starts_with(kLibrary)) {
    return fmt::format(
        "there is no {}, as where the program was built without libepoxy-dev or libegl-dev: "
        "install both and build it again",
        kLibrary);
  }
  return fmt::format(
      "{} does not load ({}): {}", kLibrary, loader_words,
      loader_words.starts_with("libepoxy") ? "install Debian's libepoxy0" : "build it again");
}

EyeDevices eyeDevices() { return gpuEyes().devices(); }

std::unique_ptr<GpuEye> openGpuEye(EyeChoice choice, const ViewScene& scene, const PatchMesh& mesh,
                                   const DeltaFormFactors& weights) {
  if (choice == EyeChoice::cpu) return nullptr;
  return openGpuEye(choice, scene, mesh, weights, gpuEyes());
}

std::unique_ptr<GpuEye> openGpuEye(EyeChoice choice, const ViewScene& scene, const PatchMesh& mesh,
                                   const DeltaFormFactors& weights, const GpuEyes& eyes) {
  if (choice == EyeChoice::cpu) return nullptr;
  if (choice == EyeChoice::automatic && startedByMpi()) return nullptr;
  const EyeDevices found = eyes.devices();
  const bool any = !found.devices.empty();
  if (choice == EyeChoice::automatic && !(any && found.devices.front().hardware)) return nullptr;
  if (!any) throw RunError(fmt::format("eye gl: {}; or take the eye cpu", found.problem));
  std::string problem;
  auto eye = eyes.open(0, GpuScene(scene, mesh), GpuWeights(weights), std::nullopt, problem);
  if (eye == nullptr) eye = std::make_unique<UnusableEye>(found.devices.front(), problem);
  return eye;
}

}  // namespace radiosity
