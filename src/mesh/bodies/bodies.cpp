#include "mesh/bodies/bodies.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

namespace radiosity {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// The places of another component's cells relative to a closed one.
struct Relation {
  std::size_t inside = 0;
  std::size_t on_skin = 0;
};

/// Relations that are not "outside altogether", by (closed component, other component).
using Relations = std::map<std::pair<Index, Index>, Relation>;

Relations relations(const Arrangement& arrangement, const Components& components,
                    const Winding& winding, std::vector<std::size_t>& cell_count) {
  Relations out;
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

/// Whether a closed surface is convex: its volume is that of its convex hull, but for a shell one
/// coincidence thick. O(n log n).
bool isConvex(const Component& component) {
  std::vector<Kernel::Point_3> points;
  const Vec3& base = component.triangles.front()[0];
  double volume = 0;
  for (const auto& t : component.triangles) {
    for (const Vec3& p : t) points.emplace_back(p.x - base.x, p.y - base.y, p.z - base.z);
    volume += glm::dot(t[0] - base, glm::cross(t[1] - base, t[2] - base)) / 6.0;
  }
  CGAL::Surface_mesh<Kernel::Point_3> hull;
  CGAL::convex_hull_3(points.begin(), points.end(), hull);
  double hull_volume = 0;
  double hull_area = 0;
  for (const auto f : hull.faces()) {
    std::array<Vec3, 3> t;
    std::size_t k = 0;
    for (const auto v : hull.vertices_around_face(hull.halfedge(f))) {
      const auto& p = hull.point(v);
      if (k < 3) t[k++] = Vec3(p.x(), p.y(), p.z());
    }
    hull_volume += glm::dot(t[0], glm::cross(t[1], t[2])) / 6.0;
    hull_area += 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
  }
  return std::abs(hull_volume - volume) <= component.coincidence * hull_area;
}

double diagonal(const Component& c) { return glm::distance(c.box.low, c.box.high); }

/// Decides what a closed two-sided component is by the components inside it.
class TwoSided {
 public:
  TwoSided(const std::vector<Component>& list, const Relations& relation,
           const std::vector<std::size_t>& cell_count)
      : list_(list), relation_(relation), cell_count_(cell_count) {}

  Body bodyOf(Index c) const {
    bool holds_whole = false;
    bool smaller_sticks_out = false;
    std::size_t not_outside = 1;  // itself
    bool outside = false;
    auto it = relation_.lower_bound({c, 0});
    for (; it != relation_.end() && it->first.first == c; ++it) {
      const Index other = it->first.second;
      if (other == c) continue;
      const auto& [inside, on_skin] = it->second;
      ++not_outside;
      const bool partly_outside = inside + on_skin < cell_count_[other];
      outside = outside || partly_outside;
      if (inside > 0 && !partly_outside) holds_whole = true;
      if (inside > 0 && partly_outside && diagonal(list_[other]) < diagonal(list_[c])) {
        smaller_sticks_out = true;
      }
    }
    outside = outside || not_outside < list_.size();
    if (outside) return holds_whole || smaller_sticks_out ? Body::none : Body::solid;
    return holds_whole || isConvex(list_[c]) ? Body::room : Body::none;
  }

 private:
  const std::vector<Component>& list_;
  const Relations& relation_;
  const std::vector<std::size_t>& cell_count_;
};

}  // namespace

Bodies::Bodies(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
               const Components& components, const Winding& winding)
    : winding_(winding) {
  const std::vector<Component>& list = components.list;
  body_.assign(list.size(), Body::none);
  cavities_.resize(list.size());
  linings_.resize(list.size());
  std::vector<std::size_t> cell_count(list.size(), 0);
  const Relations relation = relations(arrangement, components, winding, cell_count);
  const TwoSided two_sided(list, relation, cell_count);
  for (Index c = 0; c < list.size(); ++c) {
    if (!list[c].closed) continue;
    if (list[c].two_sided) {
      body_[c] = two_sided.bodyOf(c);
    } else if (!list[c].inward) {
      body_[c] = Body::solid;
    }
    if (body_[c] == Body::room) rooms_.push_back(c);
  }
  std::vector<bool> held(list.size(), false);  // only one solid holds it
  for (const auto& [pair, how] : relation) {
    const auto& [solid, other] = pair;
    const Component& within = list[other];
    const bool whole = how.inside + how.on_skin == cell_count[other];
    if (body_[solid] != Body::solid || within.two_sided || !whole) continue;
    if (!within.closed) linings_[solid].push_back(other);
    if (within.closed && within.inward) {
      cavities_[solid].push_back(other);
      held[other] = true;
    }
  }
  const std::vector<bool> shared = lookIntoSolids(arrangement, sheets, components);
  for (const auto& [pair, how] : relation) {
    const auto& [solid, other] = pair;
    if (body_[solid] == Body::solid && shared[other] && !held[other]) {
      cavities_[solid].push_back(other);
    }
  }
}

/// By component: whether it is one-sided, closed and turned inward, and all its fronts look into a
/// solid.
std::vector<bool> Bodies::lookIntoSolids(const Arrangement& arrangement,
                                         const std::vector<Sheet>& sheets,
                                         const Components& components) const {
  std::vector<bool> out;
  out.reserve(components.list.size());
  for (const Component& c : components.list) {
    out.push_back(c.closed && c.inward && !c.two_sided);
  }
  for (std::size_t k = 0; k < arrangement.cells.size(); ++k) {
    for (const auto& [sheet, layers] : arrangement.cells[k].cover) {
      const Index component = components.of_sheet[sheet];
      if (!out[component]) continue;
      const auto& before = winding_.at(Index(k), sheets[sheet].facing > 0 ? kAbove : kBelow);
      out[component] = std::any_of(before.begin(), before.end(), [&](const Winding::Entry& e) {
        return e.number >= 1 && body_[e.component] == Body::solid;
      });
    }
  }
  return out;
}

bool Bodies::isWithin(Index solid, Index cell, Side side) const {
  if (body_[solid] != Body::solid || winding_.of(solid, cell, side) < 1) return false;
  return std::none_of(cavities_[solid].begin(), cavities_[solid].end(),
                      [&](Index cavity) { return winding_.of(cavity, cell, side) >= 1; });
}

bool Bodies::isLining(Index component, Index solid) const {
  return std::binary_search(linings_[solid].begin(), linings_[solid].end(), component);
}

bool Bodies::isWithinAny(Index cell, Side side) const {
  const auto& at = winding_.at(cell, side);
  return std::any_of(at.begin(), at.end(),
                     [&](const Winding::Entry& e) { return isWithin(e.component, cell, side); });
}

}  // namespace radiosity
