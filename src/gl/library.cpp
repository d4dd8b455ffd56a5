// What the library offers to the program.
#include <new>

#include "gl/device.h"
#include "gl/gl_eye.h"

namespace radiosity {

namespace {

class OpenGlEyes final : public GpuEyes {
 public:
  EyeDevices devices() const override {
    EyeDevices found;
    for (const gl::Device& device : gl::findDevices(found.problem)) {
      found.devices.push_back(device.about);
    }
    return found;
  }

  std::unique_ptr<GpuEye> open(std::size_t d, const GpuScene& scene, const GpuWeights& weights,
                               std::string& problem) const override {
    try {
      return std::make_unique<gl::GlEye>(gl::findDevices(problem)[d], scene, weights);
    } catch (const gl::Failure& failure) {
      problem = failure.what();
      return nullptr;
    }
  }
};

}  // namespace

/// The entry point by which gpuEyes() finds this library.
extern "C" [[gnu::visibility("default")]] const GpuEyes* radiosityGpuEyes() {
  static const OpenGlEyes kEyes;
  return &kEyes;
}

}  // namespace radiosity
