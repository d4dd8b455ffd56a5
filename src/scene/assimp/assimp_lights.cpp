#include "scene/assimp/assimp_lights.h"

#include <assimp/light.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "base/finite.h"
#include "radiosity/spelling.h"
#include "scene/assimp/assimp_vectors.h"

namespace radiosity {

namespace {

/// What a kind that is not read is called.
std::string leftOut(const AssimpLight& given) {
  if (given.kind == aiLightSource_SPOT) return "spots are read of FBX alone, and left out";
  if (given.kind == aiLightSource_AREA)
    return "area lights are left out; make their surface a lamp";
  if (given.kind == aiLightSource_AMBIENT) {
    return fmt::format("ambient light is left out; light reflects by itself ({} is a sky)",
                       spelled("sky"));
  }
  return "lights of a kind that is none are left out";
}

}  // namespace

AssimpLights::AssimpLights(const std::vector<AssimpLight>& lights, std::string extension,
                           double scale, FeatureNotes& notes)
    : extension_(std::move(extension)), scale_(scale), notes_(notes) {
  for (const AssimpLight& light : lights) light_of_.emplace(light.node, &light);
}

bool AssimpLights::isRead(const AssimpLight& given) const {
  return given.kind == aiLightSource_POINT || given.kind == aiLightSource_DIRECTIONAL ||
         (given.kind == aiLightSource_SPOT && extension_ == ".fbx");
}

void AssimpLights::addNode(const std::string& node, const aiMatrix4x4& place) {
  const auto found = light_of_.find(node);
  if (found == light_of_.end()) return;
  const AssimpLight& given = *found->second;
  light_of_.erase(found);
  if (!isRead(given)) return notes_.add(leftOut(given), node, Severity::warning);
  const Vec3 at = scale_ * doublesOf(place * vectorOf(given.place));
  const Vec3 forward = doublesOf(aiMatrix3x3(place) * vectorOf(given.direction));
  const bool aimed = given.kind != aiLightSource_POINT;
  if (!isFinite(at) || (aimed && !(isFinite(forward) && glm::length(forward) > 0))) {
    return notes_.add("lights without a place or a direction are left out", node,
                      Severity::warning);
  }
  Light light{names_.make(node.empty() ? "light" : node), PointLight{at, 0}, {}, false};
  double share = 1 / (4 * std::numbers::pi);
  if (given.kind == aiLightSource_DIRECTIONAL) {
    Sun sun;
    sun.toward = -glm::normalize(forward);
    sun.diameter = 0;
    light.kind = sun;
    share = 1;
  } else if (aimed) {
    // Half of the cones' angles.
    const auto degrees = [](float angle) { return double(angle) / 2 * 180 / std::numbers::pi; };
    const double outer = degrees(given.outer);
    light.kind = SpotLight{at, at + glm::normalize(forward), std::min(degrees(given.inner), outer),
                           outer, 0};
  }
  for (const float colour : given.colour) light.strength.push_back(double(colour) * share);
  notes_.add(
      fmt::format("lamps have no unit in this format; their strength is taken as watts, of a "
                  "sun as W/m^2 ({} changes one)",
                  spelled("set", "'NAME.intensity=800cd'")),
      light.name, Severity::warning);
  placed_.push_back(std::move(light));
}

void AssimpLights::addTo(Scene& scene) {
  for (const auto& [node, light] : light_of_) {
    notes_.add("lights that no part of the scene holds are left out", node, Severity::warning);
  }
  for (Light& light : placed_) {
    try {
      light.validate();
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}; correct the light", scene.file, error.what()));
    }
    setLight(scene.lights, std::move(light));
  }
}

}  // namespace radiosity
