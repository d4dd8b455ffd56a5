#include "mesh/bodies.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>

namespace radiosity {

namespace {

/// How the cells of another component lie to a closed one.
struct Relation {
  std::size_t inside = 0;
  std::size_t on_skin = 0;
};

/// Relations that are not "outside altogether", by (closed component, other component).
std::map<std::pair<Index, Index>, Relation> relations(const Arrangement& arrangement,
                                                      const Components& components,
                                                      const Winding& winding,
                                                      std::vector<std::size_t>& cell_count) {
  std::map<std::pair<Index, Index>, Relation> out;
  for (std::size_t k = 0; k < arrangement.cells.size(); ++k) {
    for (const auto& [sheet, layers] : arrangement.cells[k].cover) {
      const Index other = components.of_sheet[sheet];
      ++cell_count[other];
      for (const auto& e : winding.at(Index(k), kAbove)) {
        const bool both = winding.of(e.component, Index(k), kBelow) != 0;
        ++(both ? out[{e.component, other}].inside : out[{e.component, other}].on_skin);
      }
      for (const auto& e : winding.at(Index(k), kBelow)) {
        const bool both = winding.of(e.component, Index(k), kAbove) != 0;
        if (!both) ++out[{e.component, other}].on_skin;
      }
    }
  }
  return out;
}

bool isConvex(const Component& component, double coincidence) {
  return std::all_of(component.triangles.begin(), component.triangles.end(), [&](const auto& t) {
    const Vec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double limit = coincidence * glm::length(n);
    return std::all_of(component.triangles.begin(), component.triangles.end(), [&](const auto& o) {
      return std::all_of(o.begin(), o.end(),
                         [&](const Vec3& p) { return glm::dot(p - t[0], n) <= limit; });
    });
  });
}

double diagonal(const Component& c) { return glm::distance(c.box.low, c.box.high); }

}  // namespace

std::vector<Body> findBodies(const Arrangement& arrangement, const Components& components,
                             const Winding& winding, double coincidence) {
  const auto& list = components.list;
  std::vector<Body> out(list.size(), Body::none);
  std::vector<std::size_t> cell_count(list.size(), 0);
  const auto relation = relations(arrangement, components, winding, cell_count);
  for (std::size_t c = 0; c < list.size(); ++c) {
    if (!list[c].closed) continue;
    if (!list[c].two_sided) {
      if (!list[c].inward) out[c] = Body::solid;
      continue;
    }
    bool holds_whole = false;
    bool smaller_sticks_out = false;
    std::size_t not_outside = 1;  // itself
    bool outside = false;
    auto it = relation.lower_bound({Index(c), 0});
    for (; it != relation.end() && it->first.first == c; ++it) {
      const Index other = it->first.second;
      if (other == c) continue;
      const auto& [inside, on_skin] = it->second;
      ++not_outside;
      const bool partly_outside = inside + on_skin < cell_count[other];
      outside = outside || partly_outside;
      if (inside > 0 && !partly_outside) holds_whole = true;
      if (inside > 0 && partly_outside && diagonal(list[other]) < diagonal(list[c])) {
        smaller_sticks_out = true;
      }
    }
    outside = outside || not_outside < list.size();
    if (outside) {
      if (!holds_whole && !smaller_sticks_out) out[c] = Body::solid;
    } else if (holds_whole || isConvex(list[c], coincidence)) {
      out[c] = Body::room;
    }
  }
  return out;
}

}  // namespace radiosity
