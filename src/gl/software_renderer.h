// Recognises OpenGL's renderers that draw on the processor.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "base/lower_case.h"

namespace radiosity::gl {

/// Whether the renderer of this name (GL_RENDERER) is Mesa's software, directly or through another
/// driver, as "zink (llvmpipe ...)". It does not depend on what EGL says of the device.
inline bool isSoftwareRenderer(std::string_view name) {
  const std::string small = lowerCase(name);
  constexpr std::array<std::string_view, 5> kSoftware = {"llvmpipe", "lavapipe", "softpipe", "swr",
                                                         "swiftshader"};
  return std::ranges::any_of(
      kSoftware, [&](std::string_view word) { return small.find(word) != std::string::npos; });
}

}  // namespace radiosity::gl
