#include "formfactor/exact/occluders.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>

#include "formfactor/exact/occluders_flat.h"
#include "formfactor/exact/occluders_polygons.h"
#include "formfactor/exact/occluders_solids.h"

namespace radiosity {
namespace {

/// The face of a solid that holds all the points, or kNone.
Index faceThatHolds(const Occluder& solid, std::span<const Vec3> points, double coincidence) {
  std::vector<std::uint8_t> on(solid.planes.size(), 1);
  for (const Vec3& p : points) {
    if (glm::distance(p, solid.centre) > solid.radius + coincidence) return kNone;
    for (std::size_t k = 0; k < solid.planes.size(); ++k) {
      const double height = glm::dot(solid.planes[k].normal, p) - solid.planes[k].offset;
      if (height > coincidence) return kNone;
      if (height < -coincidence) on[k] = 0;
    }
  }
  const auto face = std::find(on.begin(), on.end(), 1);
  return face == on.end() ? kNone : Index(face - on.begin());
}

std::vector<Vec3> cornersOf(const OccluderPolygons& all, std::span<const Index> loop) {
  std::vector<Vec3> corners;
  for (const Index v : loop) corners.push_back(all.vertices[v]);
  return corners;
}

/// Sides of each polygon of the mesh.
std::vector<std::vector<Index>> facetsOfPolygons(const ElementSet& elements, std::size_t polygons) {
  std::vector<std::vector<Index>> facets(polygons);
  for (Index f = 0; f < elements.facets.size(); ++f) {
    facets[elements.facets[f].polygon].push_back(f);
  }
  return facets;
}

/// Puts a facet that lies on a face of a solid into its list; it is sealed if it looks inside.
void attach(Occluder& solid, Index face, Index facet, const ElementSet& elements,
            std::vector<std::uint8_t>& sealed) {
  solid.facets.push_back(facet);
  if (glm::dot(elements.facets[facet].normal, solid.planes[face].normal) < 0) sealed[facet] = 1;
}

}  // namespace

OccluderSet::OccluderSet(const PatchMesh& mesh, const ElementSet& elements)
    : sealed(elements.facets.size(), 0) {
  OccluderPolygons all(mesh, elements);
  const auto facets = facetsOfPolygons(elements, mesh.polygons.size());
  std::vector<std::uint8_t> taken(all.polygons.size(), 0);
  occluders = convexSolids(all, taken);
  solids = occluders.size();
  for (Index p = 0; p < all.polygons.size(); ++p) {
    const OccluderPolygon& polygon = all.polygons[p];
    std::vector<Index> outline;
    for (const auto& loop : polygon.loops) outline.insert(outline.end(), loop.begin(), loop.end());
    const std::vector<Vec3> corners = cornersOf(all, outline);
    for (std::size_t s = 0; s < solids; ++s) {
      const Index face = faceThatHolds(occluders[s], corners, elements.coincidence);
      if (face == kNone) continue;
      taken[p] = 1;  // what it blocks the solid blocks, right behind it
      for (const Index f : facets[polygon.source]) {
        attach(occluders[s], face, f, elements, sealed);
      }
    }
    if (!taken[p] && polygon.bounds_scene) {
      taken[p] = 1;
      ++skipped_hull;
    }
  }
  for (Index f = 0; f < elements.facets.size(); ++f) {
    const Facet& facet = elements.facets[f];
    if (std::none_of(all.vertices.begin(), all.vertices.end(), [&](const Vec3& v) {
          return glm::dot(facet.normal, v) > facet.offset + elements.coincidence;
        })) {
      sealed[f] = 1;
    }
  }
  for (const FlatPiece& piece : flatPieces(all, taken)) {
    const std::vector<Vec3> corners = cornersOf(all, piece.loop);
    const bool on_solid = std::any_of(
        occluders.begin(), occluders.begin() + std::ptrdiff_t(solids), [&](const Occluder& solid) {
          return faceThatHolds(solid, corners, elements.coincidence) != kNone;
        });
    Occluder occluder;
    if (on_solid || !makeFlatOccluder(all, piece, occluder)) continue;
    for (const Index p : piece.polygons) {
      const std::vector<Index>& sides = facets[all.polygons[p].source];
      occluder.facets.insert(occluder.facets.end(), sides.begin(), sides.end());
    }
    occluders.push_back(std::move(occluder));
  }
  for (Occluder& occluder : occluders) std::sort(occluder.facets.begin(), occluder.facets.end());
}

}  // namespace radiosity
