#include "elements/element_cells.h"

#include <algorithm>

#include "elements/element_parts.h"

namespace radiosity {
namespace {

std::uint64_t edgeKey(Index a, Index b) {
  return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
}

}  // namespace

ElementCells::ElementCells(const PatchMesh& mesh, const Elements& elements)
    : elements_(elements), positions_(mesh.vertices) {
  // The first pass over all cells finds the edges that are cut.
  const Cut cut = [this](Index a, Index b) { return cutEdge(a, b); };
  for (std::size_t r = 0; r < elements.roots.size(); ++r) {
    if (isEvaluated(r)) forCellsOf(r, cut, [](ElementCell) {});
  }
}

bool ElementCells::isEvaluated(std::size_t root) const {
  return elements_.indirect.elements[root].corners != 0;
}

Index ElementCells::cutEdge(Index a, Index b) {
  const auto [at, fresh] = middles_.try_emplace(edgeKey(a, b), Index(positions_.size()));
  if (fresh) {
    const Vec3 place = 0.5 * (positions_[a] + positions_[b]);
    positions_.push_back(place);
  }
  return at->second;
}

Index ElementCells::middle(Index a, Index b) const {
  const auto found = middles_.find(edgeKey(a, b));
  return found == middles_.end() ? kNone : found->second;
}

void ElementCells::forCells(std::size_t root, const std::function<void(ElementCell)>& leaf) const {
  forCellsOf(
      root, [this](Index a, Index b) { return middle(a, b); }, leaf);
}

void ElementCells::forCellsOf(std::size_t root, const Cut& middle,
                              const std::function<void(ElementCell)>& leaf) const {
  Node node;
  node.corners = elements_.roots.cornerCount(root);
  node.point = elements_.roots.corner[root];
  for (std::size_t which = 0; which < 2; ++which) node.field[which] = rootBranch(which, root);
  descend(node, middle, leaf);
}

Vec3 ElementCells::valueAt(std::size_t which, Index vertex) const {
  const auto bands = std::size_t(elements_.bands);
  const double* value = field(which).values.data() + vertex * bands;
  return bands == 1 ? Vec3(value[0]) : Vec3(value[0], value[1], value[2]);
}

/// The root's branch of a field; dark if the field was not evaluated, since it has no light.
ElementCells::Branch ElementCells::rootBranch(std::size_t which, std::size_t root) const {
  Branch branch;
  const Element& element = field(which).elements[root];
  if (element.corners == 0) return branch;
  branch.element = Index(root);
  for (std::size_t k = 0; k < element.corners; ++k) {
    branch.value[k] = valueAt(which, field(which).points[element.first_point + k]);
  }
  return branch;
}

/// Whether a branch has parts. A tested leaf has them, too: its light is known at their corners.
bool ElementCells::isCut(std::size_t which, const Branch& branch) const {
  return branch.element != kNone && field(which).elements[branch.element].tested != 0;
}

std::array<ElementCells::Branch, 4> ElementCells::partsOfBranch(std::size_t which,
                                                                const Branch& branch,
                                                                std::size_t corners) const {
  std::array<Vec3, 9> value{};
  Index first_child = kNone;
  if (isCut(which, branch)) {
    const Element& element = field(which).elements[branch.element];
    first_child = element.first_child;
    for (std::size_t k = 0; k < pointCount(corners, true); ++k) {
      value[k] = valueAt(which, field(which).points[element.first_point + k]);
    }
  } else {
    for (std::size_t k = 0; k < corners; ++k) {
      value[k] = branch.value[k];
      value[corners + k] = 0.5 * (branch.value[k] + branch.value[(k + 1) % corners]);
    }
    if (corners == 4) value[8] = 0.5 * (value[4] + value[6]);
  }
  std::array<Branch, 4> parts;
  for (std::size_t part = 0; part < 4; ++part) {
    if (first_child != kNone) parts[part].element = first_child + Index(part);
    for (std::size_t k = 0; k < 4; ++k) {
      parts[part].value[k] = value[partsOf(corners)[part][k]];
    }
  }
  return parts;
}

void ElementCells::descend(const Node& node, const Cut& middle,
                           const std::function<void(ElementCell)>& leaf) const {
  const std::size_t n = node.corners;
  if (!isCut(0, node.field[0]) && !isCut(1, node.field[1])) {
    std::array<CellCorner, 4> corner;
    for (std::size_t k = 0; k < n; ++k) {
      corner[k] = {node.point[k], {node.field[0].value[k], node.field[1].value[k]}};
    }
    leaf(ElementCell(corner).first(n));
    return;
  }
  std::array<Index, 9> point{};
  for (std::size_t k = 0; k < n; ++k) {
    point[k] = node.point[k];
    point[n + k] = middle(node.point[k], node.point[(k + 1) % n]);
  }
  if (n == 4) point[8] = middle(point[4], point[6]);
  const std::array<Branch, 4> direct = partsOfBranch(0, node.field[0], n);
  const std::array<Branch, 4> indirect = partsOfBranch(1, node.field[1], n);
  for (std::size_t part = 0; part < 4; ++part) {
    Node child{{direct[part], indirect[part]}, {}, n};
    for (std::size_t k = 0; k < 4; ++k) child.point[k] = point[partsOf(n)[part][k]];
    descend(child, middle, leaf);
  }
}

}  // namespace radiosity
