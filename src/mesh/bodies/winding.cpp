#include "mesh/bodies/winding.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "base/union_find.h"
#include "mesh/box_pairs.h"
#include "scene/checks/winding_tree.h"

namespace radiosity {

namespace {

/// The cells of a space that are looked at, the roomiest. If they disagree, bodies are in contact
/// but for a little more than coincidence, and no edge parts what lies in the contact from the
/// rest: a cell with a corner 4e-6 m inside another body. Then each cell looks for itself.
constexpr std::size_t kEyes = 5;

/// The winding numbers that a thread finds at a time.
constexpr std::size_t kPairsAtOnce = 64;

/// A cell at an edge, with the spaces on its sides of larger and of smaller angles about the edge.
/// (RingCell of hollows.cpp has the angle, too, since any number of cells may be at an edge there.)
struct EdgeCell {
  Index after;
  Index before;
};

/// Joins the sides that look into one space. Around an edge with just two cells there are just two
/// spaces: one side of each cell shares a space with the opposite side of the other. Every contact
/// is an edge, so no other cell passes there.
UnionFind joinSpaces(const Arrangement& arrangement) {
  UnionFind spaces(2 * arrangement.cells.size());
  std::vector<EdgeCell> cells;
  for (const auto& at_edge : arrangement.sides) {
    cells.clear();
    for (const EdgeSides& s : at_edge) {
      // About the edge from a to b, a cell on its left has larger angles above.
      if (s.left != kNone) cells.push_back({2 * s.left + kAbove, 2 * s.left + kBelow});
      if (s.right != kNone) cells.push_back({2 * s.right + kBelow, 2 * s.right + kAbove});
    }
    if (cells.size() != 2) continue;
    spaces.unite(cells[0].after, cells[1].before);
    spaces.unite(cells[0].before, cells[1].after);
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

/// The closed components, to be seen from cells' sides.
class Surroundings {
 public:
  Surroundings(const std::vector<PlaneCell>& cells, const std::vector<Plane>& planes,
               const std::vector<Sheet>& sheets, const Components& components, Progress& progress)
      : cells_(cells),
        planes_(planes),
        sheets_(sheets),
        components_(components),
        progress_(progress) {
    for (Index c = 0; c < components.list.size(); ++c) {
      const Component& component = components.list[c];
      if (!component.closed) continue;
      closed_.push_back(c);
      trees_.push_back(treeOf(component));
      boxes_.push_back(component.box.grown(component.coincidence));
    }
  }

  /// The winding numbers other than 0 at each eye (2 cell + side).
  std::vector<std::vector<Winding::Entry>> lookFrom(const std::vector<Index>& eyes) const {
    std::vector<Box3> boxes(eyes.size());
    for (std::size_t e = 0; e < eyes.size(); ++e) boxes[e].add(cells_[eyes[e] / 2].sample);
    boxes.insert(boxes.end(), boxes_.begin(), boxes_.end());
    std::vector<Index> bodies(closed_.size());
    std::iota(bodies.begin(), bodies.end(), Index(eyes.size()));
    std::vector<std::pair<Index, Index>> pairs;  // an eye, a closed component
    for (const auto& [eye, box] : overlappingPairs(boxes, bodies)) {
      if (eye < eyes.size() && box >= eyes.size()) pairs.emplace_back(eye, box - eyes.size());
    }
    std::vector<int> numbers(pairs.size());
    parallelFor(pairs.size(), kPairsAtOnce, [&](std::size_t p) {
      if (progress_.cancelled()) return;
      numbers[p] = numberAt(eyes[pairs[p].first], pairs[p].second);
    });
    progress_.check();
    std::vector<std::vector<Winding::Entry>> seen(eyes.size());
    // Pairs are sorted by eye, then by component, so entries ascend.
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      const auto [eye, k] = pairs[p];
      if (numbers[p] != 0) seen[eye].push_back({closed_[k], numbers[p]});
    }
    return seen;
  }

 private:
  /// The winding number of the k-th closed component at an eye.
  int numberAt(Index eye, std::size_t k) const {
    const PlaneCell& cell = cells_[eye / 2];
    const Side side = eye % 2 == 0 ? kAbove : kBelow;
    const double w = trees_[k].around(inFrontOf(cell, side), cell.plane) +
                     ownPlane(cell, side, closed_[k], sheets_, components_);
    return int(std::lround(w));
  }

  /// A point off the cell, past surfaces that coincide with it but have planes of their own.
  Vec3 inFrontOf(const PlaneCell& cell, Side side) const {
    const double height = 2.0 * planes_[cell.plane].coincidence;
    return cell.sample + planes_[cell.plane].normal * (side == kAbove ? height : -height);
  }

  const std::vector<PlaneCell>& cells_;
  const std::vector<Plane>& planes_;
  const std::vector<Sheet>& sheets_;
  const Components& components_;
  Progress& progress_;
  std::vector<Index> closed_;
  std::vector<WindingTree> trees_;  // of each closed component
  std::vector<Box3> boxes_;
};

/// The first of a space's sides, from which it is looked at.
std::span<const Index> eyesOf(const std::vector<Index>& sides) {
  return std::span(sides).first(std::min(sides.size(), kEyes));
}

/// The cells' sides of each space, the roomiest of them first.
std::vector<std::vector<Index>> membersOf(const std::vector<PlaneCell>& cells, UnionFind joined) {
  std::vector<Index> number(2 * cells.size(), kNone);
  std::vector<std::vector<Index>> members;
  for (Index k = 0; k < 2 * cells.size(); ++k) {
    Index& space = number[joined.find(k)];
    if (space == kNone) {
      space = Index(members.size());
      members.emplace_back();
    }
    members[space].push_back(k);
  }
  for (std::vector<Index>& sides : members) {
    const auto looked = sides.begin() + std::ptrdiff_t(eyesOf(sides).size());
    std::partial_sort(sides.begin(), looked, sides.end(), [&](Index a, Index b) {
      const double room_a = cells[a / 2].room;
      const double room_b = cells[b / 2].room;
      return room_a != room_b ? room_a > room_b : a < b;
    });
  }
  return members;
}

/// Whether all lists have the same entries.
bool agree(std::span<const std::vector<Winding::Entry>> lists) {
  return std::all_of(lists.begin(), lists.end(), [&](const std::vector<Winding::Entry>& list) {
    return std::equal(list.begin(), list.end(), lists[0].begin(), lists[0].end(),
                      [](const Winding::Entry& a, const Winding::Entry& b) {
                        return a.component == b.component && a.number == b.number;
                      });
  });
}

}  // namespace

Winding::Winding(const Arrangement& arrangement, const std::vector<Plane>& planes,
                 const std::vector<Sheet>& sheets, const Components& components,
                 Progress& progress) {
  const auto& cells = arrangement.cells;
  const Surroundings around(cells, planes, sheets, components, progress);
  const std::vector<std::vector<Index>> members = membersOf(cells, joinSpaces(arrangement));
  std::vector<Index> eyes;
  for (const std::vector<Index>& sides : members) {
    const std::span<const Index> some = eyesOf(sides);
    eyes.insert(eyes.end(), some.begin(), some.end());
  }
  std::vector<std::vector<Entry>> seen = around.lookFrom(eyes);
  space_.resize(2 * cells.size());
  std::vector<Index> apart;
  auto first = seen.begin();
  for (const std::vector<Index>& sides : members) {
    const std::size_t count = eyesOf(sides).size();
    if (agree(std::span(first, count))) {
      for (const Index k : sides) space_[k] = Index(spaces_.size());
      spaces_.push_back(std::move(*first));
    } else {
      apart.insert(apart.end(), sides.begin(), sides.end());
    }
    first += std::ptrdiff_t(count);
  }
  seen = around.lookFrom(apart);
  for (std::size_t k = 0; k < apart.size(); ++k) {
    space_[apart[k]] = Index(spaces_.size());
    spaces_.push_back(std::move(seen[k]));
  }
}

int Winding::of(Index component, Index cell, Side side) const {
  for (const Entry& e : at(cell, side)) {
    if (e.component == component) return e.number;
  }
  return 0;
}

}  // namespace radiosity
