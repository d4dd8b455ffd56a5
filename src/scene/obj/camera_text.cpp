#include "scene/obj/camera_text.h"

#include <fmt/format.h>

#include <map>
#include <numbers>
#include <optional>
#include <vector>

#include "base/parse.h"
#include "scene/text.h"

namespace radiosity {

namespace {

constexpr const char* kForm = "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES";

double number(std::string_view key, std::string_view text) {
  const std::optional<double> value = parseNumber(trimmed(text));
  if (!value) {
    throw InputError(fmt::format("camera: {}: \"{}\" is not a finite number", key, trimmed(text)));
  }
  return *value;
}

Vec3 point(std::string_view key, std::string_view text) {
  const std::vector<std::string_view> numbers = splitAt(text, ',');
  if (numbers.size() != 3) {
    throw InputError(fmt::format("camera: {}=\"{}\" has {} numbers; it needs three, x,y,z", key,
                                 text, text.empty() ? 0 : numbers.size()));
  }
  return {number(key, numbers[0]), number(key, numbers[1]), number(key, numbers[2])};
}

using Parts = std::map<std::string_view, std::string_view>;

Parts partsOf(std::string_view text, char separator) {
  Parts found;
  const auto pieces = separator == ' ' ? splitWords(text) : splitAt(text, separator);
  for (const std::string_view piece : pieces) {
    const std::string_view part = trimmed(piece);
    if (part.empty()) continue;  // a closing separator
    const std::size_t equals = part.find('=');
    const std::string_view key = trimmed(part.substr(0, equals));
    if (key != "eye" && key != "target" && key != "up" && key != "fov") {
      throw InputError(fmt::format("camera: unknown part \"{}\"; the form is {}", key, kForm));
    }
    if (equals == std::string_view::npos) {
      throw InputError(fmt::format("camera: \"{}\" has no value; the form is {}", key, kForm));
    }
    if (!found.emplace(key, trimmed(part.substr(equals + 1))).second) {
      throw InputError(fmt::format("camera: {} is given twice", key));
    }
  }
  return found;
}

}  // namespace

Camera readCamera(std::string_view text, char separator, Up up) {
  const Parts given = partsOf(text, separator);
  for (const char* needed : {"eye", "target"}) {
    if (!given.contains(needed)) {
      throw InputError(fmt::format("camera: {} is missing; the form is {}", needed, kForm));
    }
  }
  Camera camera;
  camera.eye = point("eye", given.at("eye"));
  camera.target = point("target", given.at("target"));
  if (given.contains("up")) {
    camera.up = point("up", given.at("up"));
    if (camera.up == Vec3(0.0)) throw InputError("camera: up is 0,0,0; it must have a direction");
  } else {
    const int across = up == Up::y ? 2 : 1;
    const bool straight =
        camera.eye.x == camera.target.x && camera.eye[across] == camera.target[across];
    camera.up = Vec3(0.0);
    if (straight) {
      camera.up[across] = up == Up::y ? -1 : 1;  // the view is vertical, as on a map
    } else {
      camera.up[up == Up::y ? 1 : 2] = 1;
    }
  }
  if (given.contains("fov")) {
    camera.vertical_fov = number("fov", given.at("fov")) * std::numbers::pi / 180;
  }
  return camera;
}

}  // namespace radiosity
