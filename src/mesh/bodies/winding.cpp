#include "mesh/bodies/winding.h"

#include <cmath>
#include <numeric>
#include <utility>

#include "base/union_find.h"
#include "mesh/box_pairs.h"
#include "scene/checks/winding_tree.h"

namespace radiosity {

namespace {

/// A cell at an edge, with the spaces on its sides of larger and of smaller angles about the edge.
/// (RingCell of hollows.cpp has the angle, too, since any number of cells may be at an edge there.)
struct Wing {
  Index after;
  Index before;
};

/// Joins the sides that look into one space. Around an edge with just two cells there are just two
/// spaces: one side of each cell shares a space with the opposite side of the other. Every contact
/// is an edge, so no other cell passes there.
UnionFind joinSpaces(const Arrangement& arrangement) {
  UnionFind spaces(2 * arrangement.cells.size());
  for (const auto& at_edge : arrangement.sides) {
    std::vector<Wing> wings;
    for (const EdgeSides& s : at_edge) {
      // About the edge from a to b, a cell on its left has larger angles above.
      if (s.left != kNone) wings.push_back({2 * s.left + kAbove, 2 * s.left + kBelow});
      if (s.right != kNone) wings.push_back({2 * s.right + kBelow, 2 * s.right + kAbove});
    }
    if (wings.size() != 2) continue;
    spaces.unite(wings[0].after, wings[1].before);
    spaces.unite(wings[0].before, wings[1].after);
  }
  return spaces;
}

/// The part of the winding number that comes from the cell's own plane: one half, behind or in
/// front.
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

WindingTree treeOf(const Component& component) {
  std::vector<WindingTree::Triangle> triangles;
  triangles.reserve(component.triangles.size());
  for (std::size_t t = 0; t < component.triangles.size(); ++t) {
    triangles.push_back({component.triangles[t], component.triangle_plane[t]});
  }
  return WindingTree(std::move(triangles));
}

}  // namespace

Winding::Winding(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
                 const Components& components, double coincidence) {
  const auto& cells = arrangement.cells;
  UnionFind joined = joinSpaces(arrangement);
  // The eye of each space is at the roomiest of its cells.
  std::vector<Index> best(2 * cells.size(), kNone);
  for (Index k = 0; k < 2 * cells.size(); ++k) {
    Index& b = best[joined.find(k)];
    if (b == kNone || cells[k / 2].room > cells[b / 2].room) b = k;
  }
  space_.resize(2 * cells.size());
  std::vector<Index> eyes;  // by space: 2 cell + side
  std::vector<Index> number(2 * cells.size(), kNone);
  for (Index k = 0; k < 2 * cells.size(); ++k) {
    const Index root = joined.find(k);
    if (number[root] == kNone) {
      number[root] = Index(eyes.size());
      eyes.push_back(best[root]);
    }
    space_[k] = number[root];
  }
  spaces_.resize(eyes.size());
  lookAround(eyes, arrangement, sheets, components, coincidence);
}

/// Fills spaces_ with the winding numbers at each space's eye.
void Winding::lookAround(const std::vector<Index>& eyes, const Arrangement& arrangement,
                         const std::vector<Sheet>& sheets, const Components& components,
                         double coincidence) {
  std::vector<Box3> boxes(eyes.size());
  std::vector<Index> closed;
  std::vector<WindingTree> trees;
  for (std::size_t s = 0; s < eyes.size(); ++s) boxes[s].add(arrangement.cells[eyes[s] / 2].sample);
  for (Index c = 0; c < components.list.size(); ++c) {
    const Component& component = components.list[c];
    if (!component.closed) continue;
    closed.push_back(c);
    trees.push_back(treeOf(component));
    boxes.push_back(component.box.grown(coincidence));
  }
  std::vector<Index> bodies(closed.size());
  std::iota(bodies.begin(), bodies.end(), Index(eyes.size()));
  // Pairs are sorted by eye, then by component, so entries ascend.
  for (const auto& [eye, box] : overlappingPairs(boxes, bodies)) {
    if (eye >= eyes.size() || box < eyes.size()) continue;
    const std::size_t k = box - eyes.size();
    const PlaneCell& cell = arrangement.cells[eyes[eye] / 2];
    const Side side = eyes[eye] % 2 == 0 ? kAbove : kBelow;
    const double w = trees[k].around(cell.sample, cell.plane) +
                     ownPlane(cell, side, closed[k], sheets, components);
    const int whole = int(std::lround(w));
    if (whole != 0) spaces_[eye].push_back({closed[k], whole});
  }
}

int Winding::of(Index component, Index cell, Side side) const {
  for (const Entry& e : at(cell, side)) {
    if (e.component == component) return e.number;
  }
  return 0;
}

}  // namespace radiosity
