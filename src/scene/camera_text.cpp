#include "scene/camera_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>

#include "scene/text.h"

namespace radiosity {

std::string readCameraText(std::string_view text, Camera& camera) {
  std::string spaced(text);
  std::replace(spaced.begin(), spaced.end(), ';', ' ');
  bool has_eye = false;
  bool has_target = false;
  for (const std::string_view part : splitWords(spaced)) {
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) return fmt::format("`{}` has no =", part);
    const std::string_view key = part.substr(0, equals);
    const std::string_view value = part.substr(equals + 1);
    if (key == "fov") {
      const std::optional<double> degrees = parseNumber(value);
      if (!degrees || *degrees <= 0 || *degrees >= 180) {
        return fmt::format("fov={} is not an angle between 0 and 180 degrees", value);
      }
      camera.vertical_fov = *degrees * std::numbers::pi / 180;
      continue;
    }
    const std::optional<Vec3> point = parseTriple(value);
    if (key != "eye" && key != "target" && key != "up") {
      return fmt::format("`{}` is none of eye, target, up, fov", key);
    }
    if (!point) return fmt::format("{}={} is not three numbers x,y,z", key, value);
    if (key == "eye") camera.eye = *point;
    if (key == "target") camera.target = *point;
    if (key == "up") camera.up = *point;
    has_eye |= key == "eye";
    has_target |= key == "target";
  }
  if (!has_eye || !has_target) return "eye and target are both needed";
  if (camera.eye == camera.target) return "eye and target are the same point";
  if (glm::cross(camera.target - camera.eye, camera.up) == Vec3(0.0)) {
    return "up points along the view direction";
  }
  return {};
}

}  // namespace radiosity
