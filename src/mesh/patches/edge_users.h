// Polygons at their edges, for those who join polygons to surfaces.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A polygon that runs along an edge, from its smaller vertex to the larger or back.
struct EdgeUser {
  std::uint64_t edge = 0;  ///< edgeKey()
  bool reversed = false;
  Index polygon = kNone;

  Index low() const { return Index(edge >> 32); }
  Index high() const { return Index(edge); }
  auto operator<=>(const EdgeUser&) const = default;
};

/// The users of all edges between different points (`first`: of firstAtSamePoint()), sorted: those
/// of one edge are neighbours.
std::vector<EdgeUser> edgeUsers(const PlanarPolygons& polygons, std::span<const Index> first);

/// Calls visit(users of an edge) for every edge of sorted users.
template <class Visit>
void forEdges(std::span<const EdgeUser> users, const Visit& visit) {
  for (std::size_t from = 0; from < users.size();) {
    std::size_t to = from + 1;
    while (to < users.size() && users[to].edge == users[from].edge) ++to;
    visit(users.subspan(from, to - from));
    from = to;
  }
}

}  // namespace radiosity
