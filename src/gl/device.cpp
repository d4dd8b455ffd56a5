#include "gl/device.h"

#include <dlfcn.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "gl/software_renderer.h"

namespace radiosity::gl {

namespace {

/// The library that is missing, in words; empty if none is. We look first, since libepoxy ends the
/// program if it misses a library.
std::string missingLibrary() {
  const auto opens = [](const char* name) {
    return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr;
  };
  if (!opens("libEGL.so.1")) return "there is no libEGL.so.1: install Debian's libegl1";
  if (!opens("libOpenGL.so.0") && !opens("libGL.so.1")) {
    return "there is no libOpenGL.so.0: install Debian's libopengl0";
  }
  return {};
}

bool hasWord(const char* words, std::string_view word) {
  std::string_view rest = words == nullptr ? "" : words;
  while (!rest.empty()) {
    const std::string_view first = rest.substr(0, rest.find(' '));
    if (first == word) return true;
    rest.remove_prefix(std::min(rest.size(), first.size() + 1));
  }
  return false;
}

/// Displays of all devices, and whether EGL says that they are hardware.
struct FoundDisplay {
  EGLDisplay display;
  bool hardware;
};

std::vector<FoundDisplay> findDisplays() {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<FoundDisplay> found;
  if (hasWord(client, "EGL_EXT_platform_device") &&
      (hasWord(client, "EGL_EXT_device_enumeration") || hasWord(client, "EGL_EXT_device_base"))) {
    std::array<EGLDeviceEXT, 64> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(EGLint(devices.size()), devices.data(), &count) == EGL_FALSE) count = 0;
    for (EGLint d = 0; d < count; ++d) {
      EGLDeviceEXT device = devices[std::size_t(d)];
      const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
      found.push_back({eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr),
                       !hasWord(extensions, "EGL_MESA_device_software")});
    }
  }
  if (found.empty() && hasWord(client, "EGL_MESA_platform_surfaceless")) {
    found.push_back(
        {eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                  reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr),
         true});
  }
  return found;
}

const char* text(GLenum name) { return reinterpret_cast<const char*>(glGetString(name)); }

/// The feature that the current context lacks; null if it has all.
const char* lacking() {
  if (epoxy_gl_version() < 43) return "OpenGL 4.3";
  if (epoxy_gl_version() >= 45) return nullptr;
  if (!epoxy_has_gl_extension("GL_ARB_clip_control")) return "GL_ARB_clip_control";
  return epoxy_has_gl_extension("GL_ARB_buffer_storage") ? nullptr : "GL_ARB_buffer_storage";
}

const std::string kInstallDriver =
    ": install a driver (in software: libegl-mesa0 and libgl1-mesa-dri)";

struct FoundDevices {
  std::vector<Device> devices;
  std::string problem = "there is no device" + kInstallDriver;
};

void lookAt(const FoundDisplay& found, FoundDevices& all) {
  EGLint major = 0;
  EGLint minor = 0;
  if (eglInitialize(found.display, &major, &minor) == EGL_FALSE) {
    if (all.devices.empty()) all.problem = "no driver starts" + kInstallDriver;
    return;
  }
  try {
    const Context context(found.display);
    const Context::Current current(context);
    const std::string name = text(GL_RENDERER);
    if (const char* what = lacking()) {
      all.problem = name + " lacks " + what + ": install a newer driver";
      return;
    }
    all.devices.push_back({found.display,
                           {name, std::string("OpenGL ") + text(GL_VERSION),
                            found.hardware && !isSoftwareRenderer(name)}});
  } catch (const Failure& failure) {
    all.problem = failure.what();
  }
}

FoundDevices lookForDevices() {
  FoundDevices all;
  if (const std::string missing = missingLibrary(); !missing.empty()) {
    all.problem = missing;
    return all;
  }
  for (const FoundDisplay& found : findDisplays()) lookAt(found, all);
  std::stable_sort(all.devices.begin(), all.devices.end(), [](const Device& a, const Device& b) {
    return a.about.hardware > b.about.hardware;
  });
  return all;
}

/// Whether the device is lost. False, too, if the driver of the current context cannot tell.
bool isLost() {
  if (epoxy_gl_version() >= 45 || epoxy_has_gl_extension("GL_KHR_robustness")) {
    return glGetGraphicsResetStatus() != GL_NO_ERROR;
  }
  return epoxy_has_gl_extension("GL_ARB_robustness") &&
         glGetGraphicsResetStatusARB() != GL_NO_ERROR;
}

}  // namespace

const std::vector<Device>& findDevices(std::string& problem) {
  static const FoundDevices found = lookForDevices();
  problem = found.devices.empty() ? found.problem : "";
  return found.devices;
}

Context::Context(EGLDisplay display) : display_(display) {
  eglBindAPI(EGL_OPENGL_API);
  const auto create = [&](EGLint strategy) {
    const std::array<EGLint, 9> wanted = {EGL_CONTEXT_MAJOR_VERSION,
                                          4,
                                          EGL_CONTEXT_MINOR_VERSION,
                                          3,
                                          EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                          EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                          strategy,
                                          EGL_NONE};
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted.data());
  };
  // We first ask for a context that reports the loss of the device, which not every driver has.
  context_ = create(EGL_LOSE_CONTEXT_ON_RESET);
  if (context_ == EGL_NO_CONTEXT) context_ = create(EGL_NO_RESET_NOTIFICATION);
  if (context_ == EGL_NO_CONTEXT) {
    throw Failure("a driver gives no core profile of OpenGL 4.3: install a newer driver");
  }
}

Context::~Context() { eglDestroyContext(display_, context_); }

Context::Current::Current(const Context& context) : display_(context.display_) {
  eglBindAPI(EGL_OPENGL_API);
  if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_) == EGL_FALSE) {
    throw Failure("the driver takes no context without a surface");
  }
}

Context::Current::~Current() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

void check(const std::string& doing) {
  if (isLost()) throw Failure("the device was lost while " + doing);
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  const std::string what = error == GL_OUT_OF_MEMORY ? "the device has no memory left"
                                                     : "OpenGL says error " + std::to_string(error);
  throw Failure(what + " while " + doing);
}

}  // namespace radiosity::gl
