// The description of a lit scene in the header of a page's container.
#pragma once

#include <string>
#include <vector>

#include "page/container.h"
#include "radiosity/page.h"

namespace radiosity::page {

/// Colours of patches, N * 3 each; one band is repeated three times.
struct PatchColours {
  std::vector<double> reflectance;
  std::vector<double> emission;    ///< W/m^2
  std::vector<double> irradiance;  ///< W/m^2
};
/// Errors: as rgbOf().
PatchColours patchColours(const PatchMaterials& materials, const Solution& solution);

std::vector<float> floats(std::span<const double> values);

/// The colours of a material: the common value of its patches, to the bit, or their mean by area.
struct MaterialColours {
  Vec3 reflectance{0.0};
  Vec3 emission{0.0};     ///< W/m^2
  bool textured = false;  ///< patches differ
};
/// The colours of each material of the scene; those of the scene itself if it has no patches.
std::vector<MaterialColours> materialColours(const Scene& scene, const PatchMesh& mesh,
                                             const PatchColours& patches);

/// Writes title, view, surfaces and materials.
void describeScene(Container::Json& header, const Scene& scene, const PatchMesh& mesh,
                   const PatchColours& patches, const PageOptions& options);
/// Writes the method, the solver and their errors.
void describeSolution(Container::Json& header, const FormFactors& factors, const Solution& solution,
                      const PipelineOptions& options);
void describe(Container::Json& header, const FactorQuantisation& quantisation);

}  // namespace radiosity::page
