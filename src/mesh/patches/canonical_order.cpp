#include "mesh/patches/canonical_order.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace radiosity {

std::vector<Index> canonicalOrder(const PatchMesh& mesh) {
  std::vector<Index> surfaces(mesh.surface_names.size());
  std::iota(surfaces.begin(), surfaces.end(), Index(0));
  std::stable_sort(surfaces.begin(), surfaces.end(),
                   [&](Index a, Index b) { return mesh.surface_names[a] < mesh.surface_names[b]; });
  std::vector<Index> place(surfaces.size());
  for (Index k = 0; k < surfaces.size(); ++k) place[surfaces[k]] = k;
  std::vector<Index> order(mesh.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::tuple(place[mesh.surface[a]], mesh.index_in_surface[a], mesh.side[a]) <
           std::tuple(place[mesh.surface[b]], mesh.index_in_surface[b], mesh.side[b]);
  });
  return order;
}

}  // namespace radiosity
