// --camera "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES"
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>
#include <string_view>

#include "radiosity/render.h"
#include "render/view.h"

namespace radiosity {
namespace {

constexpr const char* kForm = "eye=x,y,z;target=x,y,z;up=x,y,z;fov=DEGREES";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const auto end = text.find(separator);
    parts.push_back(trimmed(text.substr(0, end)));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

double number(std::string_view key, std::string_view text) {
  double value = 0;
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw InputError(fmt::format("camera: {}: \"{}\" is not a finite number", key, text));
  }
  return value;
}

Vec3 point(std::string_view key, std::string_view text) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) {
    throw InputError(fmt::format("camera: {}=\"{}\" has {} numbers; it needs three, x,y,z", key,
                                 text, text.empty() ? 0 : parts.size()));
  }
  return {number(key, parts[0]), number(key, parts[1]), number(key, parts[2])};
}

using Parts = std::map<std::string_view, std::string_view>;

Parts parts(std::string_view text) {
  Parts found;
  for (const std::string_view part : split(text, ';')) {
    if (part.empty()) continue;  // a closing semicolon
    const auto equals = part.find('=');
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

Camera parseCamera(const std::string& text) {
  const Parts given = parts(text);
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
  } else if (camera.eye.x == camera.target.x && camera.eye.z == camera.target.z) {
    camera.up = {0, 0, -1};  // straight up or down, as on a map
  }
  if (given.contains("fov")) {
    const double degrees = number("fov", given.at("fov"));
    camera.vertical_fov = degrees * std::numbers::pi / 180;
  }
  makeView(camera, 1, 1);  // the checks every camera has to pass
  return camera;
}

}  // namespace radiosity
