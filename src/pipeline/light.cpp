// What is drawn of the stages.
#include <fmt/format.h>

#include "base/luminance.h"
#include "base/made.h"
#include "radiosity/pipeline.h"

namespace radiosity {

namespace {

/// Of three bands a patch.
std::vector<double> luminanceOfEach(std::span<const double> rgb) {
  std::vector<double> out(rgb.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = luminanceOf({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]});
  }
  return out;
}

std::vector<double> rowOf(const ExchangeMatrix& matrix, std::size_t patch) {
  std::vector<double> row(matrix.size(), 0.0);
  matrix.forRow(patch, [&](Index j, double f) { row[j] = f; });
  return row;
}

}  // namespace

SurfaceLight Pipeline::solvedLight() {
  const Solution& light = solution();
  return surfaceLight(light.radiosity, materialsOfMesh());
}

SurfaceLight Pipeline::gatheredLight() {
  const Gathered& light = gathered();
  const PatchMesh& patches = made(results_.mesh).mesh;
  SurfaceLight drawn = surfaceLight(patchRadiosity(patches, light), materialsOfMesh());
  if (light.at == GatherAt::vertices) drawn.corners = cornerRadiosity(patches, light);
  return drawn;
}

ScalarField Pipeline::field(Quantity quantity, std::size_t patch) {
  switch (quantity) {
    case Quantity::radiosity:
      return {luminanceOfEach(solution().radiosity), {"radiosity B (Rec. 709 luminance)", "W/m^2"}};
    case Quantity::irradiance:
      return {luminanceOfEach(solution().irradiance),
              {"irradiance H (Rec. 709 luminance)", "W/m^2"}};
    case Quantity::form_factor:
      return {rowOf(matrix(), patch), {fmt::format("form factor from patch {}", patch), ""}};
    case Quantity::row_sum:
      break;
  }
  return {factors().fronts, {"row sum: fronts seen", ""}};
}

}  // namespace radiosity
