#include "cli/light_cure.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/words.h"

namespace radiosity::cli {

namespace {

/// A surface that emits light.
const Surface* lampOf(const Scene& scene) {
  for (const Surface& surface : scene.surfaces) {
    if (scene.materials[surface.material].emission != Vec3(0.0)) return &surface;
  }
  return nullptr;
}

}  // namespace

std::string lightCure(const Request& request, const Scene& scene) {
  if (const Surface* lamp = lampOf(scene)) {
    return fmt::format(
        "{} emits light, but the mesh has nothing of it, for a reason that a warning gives; if it "
        "is in a room whose faces are turned outward, give these both sides: --two-sided all",
        lamp->name);
  }
  std::string command;
  for (const std::string& argument : request.arguments) command += shellWord(argument) + " ";
  return fmt::format(
      "make something a lamp: {}--set {} (W/m^2/sr), or light an open scene from "
      "outside: --sky 1",
      command, shellWord(likelyLamp(scene) + ".radiance=10"));
}

std::string darknessText(const Request& request, const Scene& scene, int bands) {
  if (bands != 3) {
    return fmt::format(
        "nothing emits light, so B = 0 everywhere; give patches an emission above 0 in /solution "
        "of {}",
        request.input);
  }
  const auto isLamp = [](const Light& light) { return light.shines() && light.place(); };
  const char* why = std::ranges::any_of(scene.lights, isLamp)
                        ? "no light reaches a front: lamps stand inside of bodies, behind surfaces "
                          "or too far away"
                    : anyShinesIn(scene.lights)
                        ? "nothing emits light and no patch sees the sky (the scene is closed)"
                        : "nothing emits light";
  return fmt::format("{}, so B = 0 everywhere; {}", why, lightCure(request, scene));
}

}  // namespace radiosity::cli
