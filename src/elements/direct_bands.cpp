#include "elements/direct_bands.h"

#include <optional>

#include "elements/direct_light.h"
#include "elements/emitters.h"
#include "elements/field_builder.h"
#include "elements/surface_points.h"
#include "formfactor/rays/point_rays.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

ElementField directBands(const PatchMesh& mesh, const PatchMaterials& materials,
                         const ElementOptions& options, const ElementField& like,
                         Progress& progress) {
  const ElementSurface surface(mesh, options.crease, kDirectInset, kIndirectInset);
  const ElementSet elements(mesh);
  const std::vector<Emitter> emitters = findEmitters(mesh, elements, materials);
  if (emitters.size() > kMostAimedEmitters) return {};
  const PointRays rays(mesh);
  std::optional<OccluderSet> occluders;
  if (!emitters.empty() && emitters.size() <= kMostClippedEmitters) {
    occluders.emplace(mesh, elements, progress);
  }
  const EmitterLight light(mesh, materials, surface, elements, occluders ? &*occluders : nullptr,
                           emitters, rays);
  RefinementRule rule;
  rule.like = &like;
  const std::vector<double> no_other_light(mesh.size(), 0.0);
  rule.other_light = no_other_light;
  return buildField(mesh, surface, light, rule, materials.bands, "light of each lamp", progress)
      .field;
}

}  // namespace radiosity
