// What the header of a page's container says of a lit scene, besides where its arrays lie.
#pragma once

#include <string>
#include <vector>

#include "page/container.h"
#include "radiosity/page.h"

namespace radiosity::page {

/// Colours of patches, N * 3 each, whatever the number of bands: one band three times.
struct PatchColours {
  std::vector<double> reflectance;
  std::vector<double> emission;    ///< W/m^2
  std::vector<double> irradiance;  ///< W/m^2
  std::vector<double> sky;         ///< 3: radiance, W/m^2/sr
};
/// Errors: as rgbOf().
PatchColours patchColours(const PatchMaterials& materials, const Solution& solution);

/// The mean over the area of the patches that have it, or what they all have, to the bit.
struct MaterialColours {
  Vec3 reflectance{0.0};
  Vec3 emission{0.0};     ///< W/m^2
  bool textured = false;  ///< patches differ
};
/// One a material of the scene; of those without patches, as the scene says.
std::vector<MaterialColours> materialColours(const Scene& scene, const PatchMesh& mesh,
                                             const PatchColours& patches);

/// Title, view, surfaces and materials.
void describeScene(Container::Json& header, const Scene& scene, const PatchMesh& mesh,
                   const PatchColours& patches, const PageOptions& options);
/// Method, solver and what they say of their errors.
void describeSolution(Container::Json& header, const FormFactors& factors, const Solution& solution,
                      const PipelineOptions& options);
void describe(Container::Json& header, const FactorQuantisation& quantisation);

}  // namespace radiosity::page
