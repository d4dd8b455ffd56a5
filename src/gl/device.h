// Devices that EGL finds without a window system, and contexts on them.
#pragma once

#include <epoxy/egl.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity::gl {

/// OpenGL does not do what it should: out of memory, a lost device, an error of the driver.
class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct Device {
  EGLDisplay display = EGL_NO_DISPLAY;
  EyeDevice about;
};

/// Devices with what the eye needs, hardware first; looked for once. Where there are none `problem`
/// says why. Displays stay open.
const std::vector<Device>& findDevices(std::string& problem);

/// A core profile of OpenGL 4.3 or later, without a surface.
class Context {
 public:
  /// Failure where the display gives none.
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

/// Failure where OpenGL has noted an error or lost the device since the last call. Of the current
/// context.
void check(const std::string& doing);

}  // namespace radiosity::gl
