#include "elements/emitters.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "base/geometry/plane_frame.h"
#include "visibility/elements/convex_pieces.h"

namespace radiosity {
namespace {

std::span<const double> exitance(const PatchMaterials& materials, Index patch) {
  const auto bands = std::size_t(materials.bands);
  return std::span(materials.emission).subspan(patch * bands, bands);
}

bool shines(const PatchMaterials& materials, Index patch) {
  const auto of = exitance(materials, patch);
  return std::any_of(of.begin(), of.end(), [](double m) { return m > 0; });
}

void append(const Facet& facet, Index number, Index patch, std::vector<Vec3> outline,
            std::vector<Emitter>& emitters) {
  Emitter emitter;
  emitter.area = glm::length(vectorArea(outline.size(), [&](std::size_t k) { return outline[k]; }));
  if (!(emitter.area > 0)) return;
  emitter.normal = facet.normal;
  emitter.offset = facet.offset;
  emitter.facet = number;
  emitter.patch = patch;
  for (const Vec3& corner : outline) emitter.centre += corner / double(outline.size());
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& corner = outline[std::min(k, outline.size() - 1)];
    emitter.shape.x[k] = corner.x;
    emitter.shape.y[k] = corner.y;
    emitter.shape.z[k] = corner.z;
    emitter.radius = std::max(emitter.radius, glm::distance(corner, emitter.centre));
  }
  emitter.outline = std::move(outline);
  emitters.push_back(std::move(emitter));
}

}  // namespace

std::vector<Emitter> findEmitters(const PatchMesh& mesh, const ElementSet& elements,
                                  const PatchMaterials& materials) {
  std::vector<Emitter> emitters;
  for (Index f = 0; f < elements.facets.size(); ++f) {
    const Facet& facet = elements.facets[f];
    if (facet.black) continue;
    const Index first = elements.patch[facet.elements.first];
    const auto light = exitance(materials, first);
    bool alike = true;
    bool any = false;
    for (Index e = facet.elements.first; e < facet.elements.end; ++e) {
      const auto other = exitance(materials, elements.patch[e]);
      alike = alike && std::equal(light.begin(), light.end(), other.begin());
      any = any || shines(materials, elements.patch[e]);
    }
    if (!any) continue;
    if (!alike) {
      for (Index e = facet.elements.first; e < facet.elements.end; ++e) {
        if (!shines(materials, elements.patch[e])) continue;
        const auto outline = elements.outline(e);
        append(facet, f, elements.patch[e], {outline.begin(), outline.end()}, emitters);
      }
      continue;
    }
    const auto loops = polygonLoops(mesh, facet.polygon, elements.middle, elements.scale);
    for (auto& outline :
         convexPieces(loops, mesh.polygons.normal[facet.polygon], elements.coincidence)) {
      if (facet.back) std::reverse(outline.begin(), outline.end());
      append(facet, f, first, std::move(outline), emitters);
    }
  }
  return emitters;
}

}  // namespace radiosity
