#include <fmt/format.h>

#include "base/option_list.h"
#include "radiosity/spelling.h"
#include "scene/load_scene.h"

namespace radiosity {

double metresPer(const std::string& unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "m") return 1.0;
  if (unit == "in") return 0.0254;  // exact since 1959
  if (unit == "ft") return 0.3048;
  throw InputError(fmt::format("{}: not one of mm, cm, m, in, ft", spelled("unit", unit)));
}

void SceneOptions::validate() const {
  if (!unit.empty()) metresPer(unit);
  requireRanges(*this);
  SceneOverrides::validate();
}

}  // namespace radiosity
