#include "mesh/winding.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "mesh/union_find.h"

namespace radiosity {

double solidAngle(const Vec3& from, const std::array<Vec3, 3>& triangle) {
  const Vec3 a = triangle[0] - from;
  const Vec3 b = triangle[1] - from;
  const Vec3 c = triangle[2] - from;
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  const double numerator = glm::dot(a, glm::cross(b, c));
  const double denominator =
      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(numerator, denominator);
}

namespace {

/// A cell at an edge, with the space on its side of larger angles about the edge and the one on
/// its side of smaller angles.
struct Wing {
  Index after;
  Index before;
};

/// Joins the sides that look into one space. Around an edge with just two cells there are just
/// two spaces: each cell's one side shares one with the other cell's opposite side. Every contact
/// is an edge, so nothing else passes there.
UnionFind joinSpaces(const Arrangement& arrangement) {
  UnionFind spaces(2 * arrangement.cells.size());
  for (const auto& at_edge : arrangement.sides) {
    std::vector<Wing> wings;
    for (const EdgeSides& s : at_edge) {
      // About the edge from a to b, a cell on the left of it has larger angles above it.
      if (s.left != kNone) wings.push_back({2 * s.left + kAbove, 2 * s.left + kBelow});
      if (s.right != kNone) wings.push_back({2 * s.right + kBelow, 2 * s.right + kAbove});
    }
    if (wings.size() != 2) continue;
    spaces.unite(wings[0].after, wings[1].before);
    spaces.unite(wings[0].before, wings[1].after);
  }
  return spaces;
}

/// The part of the cell's own plane in its winding number: half of it, behind or in front.
double ownPlane(const PlaneCell& cell, Side side, Index component, const std::vector<Sheet>& sheets,
                const Components& components) {
  double sum = 0;
  for (const auto& [sheet, layers] : cell.cover) {
    if (components.of_sheet[sheet] != component) continue;
    const bool outward_is_above = sheets[sheet].facing * components.outward[sheet] > 0;
    const bool in_front = outward_is_above == (side == kAbove);
    sum += in_front ? -0.5 * layers : 0.5 * layers;
  }
  return sum;
}

double farPlanes(const PlaneCell& cell, const Component& component) {
  double sum = 0;
  for (std::size_t t = 0; t < component.triangles.size(); ++t) {
    if (component.triangle_plane[t] == cell.plane) continue;
    sum += solidAngle(cell.sample, component.triangles[t]);
  }
  return sum / (4.0 * std::numbers::pi);
}

}  // namespace

Winding::Winding(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
                 const Components& components, double coincidence) {
  const auto& cells = arrangement.cells;
  std::vector<Index> closed;
  for (std::size_t c = 0; c < components.list.size(); ++c) {
    if (components.list[c].closed) closed.push_back(Index(c));
  }
  UnionFind joined = joinSpaces(arrangement);
  // Each space is looked at from the roomiest of its cells.
  std::vector<Index> best(2 * cells.size(), kNone);
  for (Index k = 0; k < 2 * cells.size(); ++k) {
    Index& b = best[joined.find(k)];
    if (b == kNone || cells[k / 2].room > cells[b / 2].room) b = k;
  }
  space_.resize(2 * cells.size());
  std::vector<Index> number(2 * cells.size(), kNone);
  for (Index k = 0; k < 2 * cells.size(); ++k) {
    const Index root = joined.find(k);
    if (number[root] == kNone) {
      number[root] = Index(spaces_.size());
      spaces_.emplace_back();
      const PlaneCell& cell = cells[best[root] / 2];
      const Side side = best[root] % 2 == 0 ? kAbove : kBelow;
      for (const Index c : closed) {
        const Component& component = components.list[c];
        if (!component.box.grown(coincidence).contains(cell.sample)) continue;
        const double w = farPlanes(cell, component) + ownPlane(cell, side, c, sheets, components);
        const int whole = int(std::lround(w));
        if (whole != 0) spaces_.back().push_back({c, whole});
      }
    }
    space_[k] = number[root];
  }
}

int Winding::of(Index component, Index cell, Side side) const {
  for (const Entry& e : at(cell, side)) {
    if (e.component == component) return e.number;
  }
  return 0;
}

}  // namespace radiosity
