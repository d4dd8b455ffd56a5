#include "mesh/patches/edge_users.h"

#include "base/parallel.h"
#include "mesh/edge_key.h"

namespace radiosity {

std::vector<EdgeUser> edgeUsers(const PlanarPolygons& polygons, std::span<const Index> first) {
  std::vector<EdgeUser> users;
  users.reserve(polygons.corners.size());
  for (Index p = 0; p < polygons.size(); ++p) {
    for (std::size_t l = polygons.loopBegin(p); l < polygons.loopEnd(p); ++l) {
      const std::span<const Index> loop = polygons.loop(l);
      for (std::size_t k = 0, last = loop.size() - 1; k < loop.size(); last = k++) {
        const Index from = first[loop[last]];
        const Index to = first[loop[k]];
        if (from != to) users.push_back({edgeKey(from, to), from > to, p});
      }
    }
  }
  parallelSort(users);
  return users;
}

}  // namespace radiosity
