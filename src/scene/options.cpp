#include <fmt/format.h>

#include "scene/load_scene.h"

namespace radiosity {

double metresPer(const std::string& unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "m") return 1.0;
  if (unit == "in") return 0.0254;  // exact since 1959
  if (unit == "ft") return 0.3048;
  throw InputError(fmt::format("unit `{}` is none of mm, cm, m, in, ft", unit));
}

void SceneOptions::validate() const {
  if (!unit.empty()) metresPer(unit);
  if (!(default_reflectance >= 0 && default_reflectance <= 1)) {
    throw InputError(fmt::format("default_reflectance {} is outside 0 to 1", default_reflectance));
  }
  // A Texture counts its pixels with an int.
  if (!(max_image > 0 && max_image <= 2000)) {
    throw InputError(
        fmt::format("max image {} is not above 0 and at most 2000 million pixels", max_image));
  }
  for (const Light& light : lights) light.validate();
}

}  // namespace radiosity
