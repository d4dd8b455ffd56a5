#include "visibility/occluders/occluders.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "base/geometry/box_tree.h"
#include "visibility/occluders/clip.h"
#include "visibility/occluders/cover.h"
#include "visibility/occluders/flat.h"
#include "visibility/occluders/polygons.h"
#include "visibility/occluders/solids.h"

namespace radiosity {
namespace {

/// The facets of each polygon of the mesh.
std::vector<std::vector<Index>> facetsOfPolygons(const ElementSet& elements, std::size_t polygons) {
  std::vector<std::vector<Index>> facets(polygons);
  for (Index f = 0; f < elements.facets.size(); ++f) {
    facets[elements.facets[f].polygon].push_back(f);
  }
  return facets;
}

/// Puts a facet that lies on a face of a solid into its list; it is hidden if it looks inside.
void attach(Occluder& solid, Index face, Index facet, const ElementSet& elements,
            std::vector<std::uint8_t>& hidden_facets) {
  solid.facets.push_back(facet);
  if (glm::dot(elements.facets[facet].normal, solid.planes[face].normal) < 0)
    hidden_facets[facet] = 1;
}

/// Adds facets near a solid that has all of itself behind them, to where a plane may be off by the
/// coincidence on either side: it hides nothing from them. (Two triangles of a box's side that
/// noise has turned, and another box across the edge between them: one was part of the solid, the
/// other lay half within it by 1.07 coincidences, and half of it saw nothing.)
void addFacetsInFront(Occluder& solid, const OccluderPolygons& all,
                      const std::vector<std::vector<Index>>& facets, const ElementSet& elements) {
  const double behind = 2 * all.coincidence;
  const std::set<Index> known(solid.facets.begin(), solid.facets.end());
  all.tree.query(boxAround(solid, behind), [&](Index p) {
    for (const Index f : facets[all.polygons[p].source]) {
      const Facet& facet = elements.facets[f];
      const auto is_behind = [&](const Vec3& corner) {
        return glm::dot(facet.normal, corner) - facet.offset <= behind;
      };
      if (!known.contains(f) && std::ranges::all_of(solid.corners, is_behind)) {
        solid.facets.push_back(f);
      }
    }
    return true;
  });
}

/// Boxes of the solids, to find those at a polygon.
BoxTree placesOf(const std::vector<Occluder>& solids, double margin) {
  std::vector<Box3> boxes;
  boxes.reserve(solids.size());
  for (const Occluder& solid : solids) boxes.push_back(boxAround(solid, margin));
  return BoxTree(boxes);
}

}  // namespace

OccluderSet::OccluderSet(const PatchMesh& mesh, const ElementSet& elements) {
  Progress silent;
  *this = OccluderSet(mesh, elements, silent);
}

OccluderSet::OccluderSet(const PatchMesh& mesh, const ElementSet& elements, Progress& progress)
    : hidden_facets(elements.facets.size(), 0) {
  OccluderPolygons all(mesh, elements);
  const auto facets = facetsOfPolygons(elements, mesh.polygons.size());
  std::vector<std::uint8_t> taken(all.polygons.size(), 0);
  for (ConvexSolid& solid : convexSolids(all, taken, progress)) {
    for (const ConvexSolid::OnFace& on : solid.on_faces) {
      const Index source = all.polygons[on.polygon].source;
      for (const Index f : facets[source]) attach(solid.body, on.face, f, elements, hidden_facets);
    }
    addFacetsInFront(solid.body, all, facets, elements);
    occluders.push_back(std::move(solid.body));
  }
  solids = occluders.size();
  const BoxTree places = placesOf(occluders, all.coincidence);
  for (Index p = 0; p < all.polygons.size(); ++p) {
    progress.check();
    const OccluderPolygon& polygon = all.polygons[p];
    if (!taken[p] && polygon.bounds_scene) {
      taken[p] = 1;
      ++skipped_hull;
    }
    if (!taken[p] && isCoveredBySolids(all, polygon, occluders, places)) taken[p] = 1;
  }
  for (Index f = 0; f < elements.facets.size(); ++f) {
    progress.check();
    const Facet& facet = elements.facets[f];
    if (all.allBehind(facet.normal, facet.offset, elements.coincidence)) hidden_facets[f] = 1;
  }
  for (const FlatPiece& piece : flatPieces(all, taken, progress)) {
    Occluder occluder;
    if (!makeFlatOccluder(all, piece, occluder)) continue;
    for (const Index p : piece.polygons) {
      const std::vector<Index>& sides = facets[all.polygons[p].source];
      occluder.facets.insert(occluder.facets.end(), sides.begin(), sides.end());
    }
    occluders.push_back(std::move(occluder));
  }
  for (Occluder& occluder : occluders) std::sort(occluder.facets.begin(), occluder.facets.end());
}

}  // namespace radiosity
