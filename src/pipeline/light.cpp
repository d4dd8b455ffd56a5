// The quantities of the stages that pictures show.
#include <fmt/format.h>

#include "base/luminance.h"
#include "pipeline/stages/get_or_make.h"

namespace radiosity {

namespace {

std::vector<double> sumsOfBands(std::span<const double> values, int bands) {
  std::vector<double> sums(values.size() / std::size_t(bands), 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) sums[k / std::size_t(bands)] += values[k];
  return sums;
}

ScalarField brightnessField(const char* title, std::span<const double> values, int bands) {
  return {brightnessOfEach(values, bands), {title + brightnessText(bands), "W/m^2"}};
}

}  // namespace

SurfaceLight Pipeline::solvedLight() {
  const Solution& light = solution();
  return surfaceLight(light.radiosity, materialsOfMesh());
}

SurfaceLight Pipeline::elementLight(std::span<const std::uint8_t> wanted) {
  SurfaceLight light = solvedLight();
  const PatchMaterials& materials = materialsOfMesh();
  const StageKey key = elementsKeyNow();
  const bool there = isMadeBy(key, results_.elements) || isMadeBy(key, stored_.elements);
  light.elements = std::make_shared<const Elements>(
      wanted.empty() || there ? elements() : elementsOf(wanted, key));
  light.reflectance = materials.reflectance;
  light.emission = materials.emission;
  return light;
}

SurfaceLight Pipeline::pointLight(std::span<const std::uint8_t> wanted) {
  SurfaceLight light = solvedLight();
  const PatchMaterials& materials = materialsOfMesh();
  light.points = std::make_shared<const LightAtPoints>(made(results_.mesh).mesh, materials,
                                                       solution().irradiance, options_.elements,
                                                       wanted, progress_);
  light.reflectance = materials.reflectance;
  light.emission = materials.emission;
  return light;
}

std::shared_ptr<const PointMaterials> Pipeline::pointMaterials(
    std::span<const std::uint8_t> wanted) {
  if (hasOwnMaterials()) return nullptr;
  return radiosity::pointMaterials(scene(), made(results_.mesh).mesh, materialsOfMesh(), wanted);
}

SurfaceLight Pipeline::gatheredLight() {
  const Gathered& light = gathered();
  const PatchMesh& patches = made(results_.mesh).mesh;
  SurfaceLight drawn = surfaceLight(patchRadiosity(patches, light), materialsOfMesh());
  if (light.at == GatherAt::vertices) {
    drawn.corners = rgbOf(cornerRadiosity(patches, light), light.bands);
  }
  return drawn;
}

ScalarField Pipeline::field(Quantity quantity, std::size_t patch) {
  switch (quantity) {
    case Quantity::radiosity: {
      const Solution& light = solution();
      return brightnessField("radiosity B", light.radiosity, light.bands);
    }
    case Quantity::irradiance: {
      const Solution& light = solution();
      return brightnessField("irradiance H", light.irradiance, light.bands);
    }
    case Quantity::form_factor: {
      return {matrix().row(patch), {fmt::format("form factor from patch {}", patch), ""}};
    }
    case Quantity::temperature:
      return {heat().temperature, {"temperature", "K"}, false};
    case Quantity::net_flux:
      return {heat().net_flux, {"net flux of heat, given off", "W/m^2"}, false};
    case Quantity::heat_irradiance:
      return {sumsOfBands(heat().irradiance, heat().bands), {"irradiance of heat", "W/m^2"}};
    case Quantity::row_sum:
      break;
  }
  return {factors().fronts, {"row sum: fronts seen", ""}};
}

}  // namespace radiosity
