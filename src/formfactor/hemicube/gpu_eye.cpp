#include "formfactor/hemicube/gpu_eye.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cmath>

namespace radiosity {

namespace {

struct OpenedLibrary {
  const GpuEyes* eyes = nullptr;
  std::string problem;
};

OpenedLibrary openLibrary() {
  // Found beside this library, which carries $ORIGIN as its search path. Never closed.
  void* library = dlopen("libradiosity_gl.so", RTLD_LAZY | RTLD_LOCAL);
  void* entry = library == nullptr ? nullptr : dlsym(library, "radiosityGpuEyes");
  if (entry == nullptr) return {nullptr, dlerror()};
  return {reinterpret_cast<const GpuEyes* (*)()>(entry)(), {}};
}

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

const GpuEyes* gpuEyes(std::string& problem) {
  static const OpenedLibrary library = openLibrary();
  problem = library.problem;
  return library.eyes;
}

EyeDevices eyeDevices() {
  std::string problem;
  const GpuEyes* eyes = gpuEyes(problem);
  return eyes == nullptr ? EyeDevices{{}, problem} : eyes->devices();
}

std::unique_ptr<GpuEye> openGpuEye(EyeChoice choice, const ViewScene& scene, const PatchMesh& mesh,
                                   const DeltaFormFactors& weights) {
  if (choice == EyeChoice::cpu) return nullptr;
  const EyeDevices found = eyeDevices();
  const bool suits =
      !found.devices.empty() && (choice == EyeChoice::gl || found.devices.front().hardware);
  std::string problem = found.problem;
  if (suits) {
    auto eye = gpuEyes(problem)->open(0, GpuScene(scene, mesh), GpuWeights(weights), problem);
    if (eye != nullptr) return eye;
  }
  if (choice == EyeChoice::automatic) return nullptr;
  throw RunError(
      fmt::format("eye gl: OpenGL cannot be used ({}); install Debian's libegl1 and a driver (in "
                  "software: libegl-mesa0, libgl1-mesa-dri), or take the eye cpu",
                  problem));
}

}  // namespace radiosity
