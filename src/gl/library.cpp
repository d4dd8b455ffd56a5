// The interface of the library to the program.
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
                               std::optional<GpuPace> pace, std::string& problem) const override {
    try {
      const gl::Device& device = gl::findDevices(problem).at(d);
      return std::make_unique<gl::GlEye>(device, scene, weights,
                                         pace.value_or(gl::paceOf(device.about)));
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
