#include "page/lamps.h"

#include <algorithm>
#include <string>
#include <utility>

#include "formfactor/light_on_patches.h"
#include "page/header.h"

namespace radiosity::page {

namespace {

constexpr std::size_t kMostEmittedBytes = 32u << 20;

}  // namespace

std::vector<Emitter> emittersOf(const Scene& scene, const PatchMesh& mesh,
                                const PatchMaterials& materials) {
  const auto bands = std::size_t(materials.bands);
  std::vector<double> power(scene.materials.size(), 0.0);
  for (std::size_t k = 0; k < materials.emission.size(); ++k) {
    const std::size_t i = k / bands;
    power[scene.surfaces[mesh.surface[i]].material] += mesh.area[i] * materials.emission[k];
  }
  std::vector<Emitter> emitters;
  for (std::size_t m = 0; m < power.size(); ++m) {
    if (power[m] > 0) emitters.push_back({m, power[m]});
  }
  std::ranges::stable_sort(emitters, std::ranges::greater(), &Emitter::power);
  return emitters;
}

void addLights(const PatchMaterials& materials, const PatchMesh& mesh, const FormFactors& factors,
               Progress& progress, Container& container) {
  const int bands = materials.bands;
  Container::Json lights = Container::Json::array();
  LightOnPatches on_patches(mesh);
  for (const Light& light : materials.lights) {
    if (!light.shines()) continue;
    const std::vector<double> irradiance =
        on_patches.all({&light, 1}, factors.sky, bands, progress).irradiance;
    container.add("light_" + std::to_string(lights.size()), floats(rgbOf(irradiance, bands)));
    lights.push_back({{"name", light.name},
                      {"kind", light.traits().word},
                      {"single", light.traits().single},
                      {"unit", light.traits().unit},
                      {"strength", rgbOf(light.strength, bands)},
                      {"parameters", light.briefText()},
                      {"radiance", rgbOf(background({&light, 1}, bands), bands)}});
  }
  container.header()["lights"] = lights;
}

void addEmitted(const Scene& scene, const PatchMesh& mesh, const PatchMaterials& materials,
                const ExchangeOperator& matrix, Container& container) {
  const auto bands = std::size_t(materials.bands);
  std::vector<double> irradiance(materials.emission.size());
  std::size_t bytes = 0;
  for (const Emitter& emitter : emittersOf(scene, mesh, materials)) {
    bytes += 3 * mesh.size() * sizeof(float);
    if (bytes > kMostEmittedBytes) return;
    std::vector<double> emission(materials.emission.size(), 0.0);
    for (std::size_t k = 0; k < emission.size(); ++k) {
      const bool own = scene.surfaces[mesh.surface[k / bands]].material == emitter.material;
      if (own) emission[k] = materials.emission[k];
    }
    matrix.product(emission, materials.bands, irradiance);
    // Fits of rows that are cut may be a little below 0.
    for (double& value : irradiance) value = std::max(0.0, value);
    container.add("emitted_" + std::to_string(emitter.material),
                  floats(rgbOf(irradiance, materials.bands)));
  }
}

}  // namespace radiosity::page
