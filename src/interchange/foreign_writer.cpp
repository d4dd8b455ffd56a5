#include "interchange/foreign_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

namespace radiosity {

ForeignWriter::ForeignWriter(const Scene& scene, const ForeignPicture& picture, std::string program)
    : scene_(scene), picture_(picture), program_(std::move(program)) {}

void ForeignWriter::note(const std::string& text) {
  made_.notes.push_back({Severity::warning, program_ + ": " + text});
}

void ForeignWriter::addFile(std::string name, std::vector<std::byte> bytes) {
  made_.files.emplace_back(std::move(name), std::move(bytes));
}

std::string ForeignWriter::addReflectance(std::size_t material) {
  std::string file = fmt::format("{}-{}.exr", picture_.stem, material + 1);
  made_.images.emplace_back(file, reflectanceImage(scene_, scene_.materials[material]));
  return file;
}

void ForeignWriter::addLights() {
  for (const Light& light : scene_.lights) addLight(light);
  addSky();
}

void ForeignWriter::addLight(const Light& light) {
  if (!light.shines() || light.isAllRound()) return;
  const Vec3 strength(light.strength[0], light.strength[1], light.strength[2]);
  double range = 0;
  if (const auto* point = std::get_if<PointLight>(&light.kind)) {
    range = point->range;
    addPoint(*point, strength);
  } else if (const auto* spot = std::get_if<SpotLight>(&light.kind)) {
    range = spot->range;
    addSpot(*spot, strength);
    if (spot->inner < spot->outer) note(fmt::format("'{}' falls off {}", light.name, fallOff()));
  } else if (const auto* sun = std::get_if<Sun>(&light.kind)) {
    addSun(*sun, strength);
    if (sun->diameter > 0) {
      note(fmt::format("'{}' has sharp shadows, here a disc of {} degrees", light.name,
                       sun->diameter));
    }
  } else {
    note(fmt::format("'{}' is left out; there is no light of its kind", light.name));
  }
  if (range > 0) note(fmt::format("'{}' shines without end, here {} m far", light.name, range));
}

void ForeignWriter::addSky() {
  if (!unevenSkies(scene_.lights).empty()) {
    const SkyPixels pixels = skyPixels();
    const std::string file = picture_.stem + "-sky.exr";
    made_.images.emplace_back(
        file, skyImage(scene_.lights, pixels.width, pixels.height, pixels.direction));
    return addSkyImage(file);
  }
  const std::vector<double> radiance = background(scene_.lights, 3);
  if (std::ranges::none_of(radiance, [](double value) { return value > 0; })) return;
  addUniformSky({radiance[0], radiance[1], radiance[2]});
}

ForeignScene ForeignWriter::finish() {
  if (!scene_.colours.empty()) {
    note("colours of vertices are left out; materials have their own reflectance");
  }
  for (const Material& material : scene_.materials) {
    if (material.emission_texture == kNone) continue;
    note(fmt::format("'{}' emits the mean of its texture all over", material.name));
  }
  return std::move(made_);
}

}  // namespace radiosity
