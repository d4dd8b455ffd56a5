// Devices that EGL finds without a window system, and contexts on them.
#pragma once

#include <epoxy/egl.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity::gl {

/// A failure of OpenGL: out of memory, a lost device, or an error of the driver.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Device {
  EGLDisplay display = EGL_NO_DISPLAY;
  EyeDevice about;
};

/// The devices that have the features for the eye, hardware first. The search runs once. If there
/// are none, `problem` says why. Displays stay open.
const std::vector<Device>& findDevices(std::string& problem);

/// A core profile of OpenGL 4.3 or later, without a surface.
class Context {
 public:
  /// Throws Failure if the display gives no context.
  explicit Context(EGLDisplay display);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// While it lives, the calling thread's OpenGL calls go to this context.
  class Current {
   public:
    explicit Current(const Context& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    EGLDisplay display_;
  };

 private:
  EGLDisplay display_;
  EGLContext context_;
};

/// Throws Failure if OpenGL has had an error or lost the device since the last call, in the current
/// context.
void check(const std::string& doing);

}  // namespace radiosity::gl
