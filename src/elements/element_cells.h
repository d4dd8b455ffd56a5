// The elements of both fields laid over each other, as surfaces are exported: cells that neither
// field cuts further, and the points that they meet at.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Irradiance of both fields, W/m^2; where there is one band, three times the same. Kept apart
/// until nothing is interpolated any more: then either side of an edge has the same bits.
struct CellLight {
  Vec3 direct{0.0};
  Vec3 indirect{0.0};

  CellLight& operator+=(const CellLight& other) {
    direct += other.direct;
    indirect += other.indirect;
    return *this;
  }
  friend CellLight operator*(double factor, const CellLight& light) {
    return {factor * light.direct, factor * light.indirect};
  }
};

/// A corner of a cell.
struct CellCorner {
  Index point = 0;  ///< of ElementCells
  CellLight light;
};

/// Half-way between two corners.
inline CellLight between(const CellLight& a, const CellLight& b) {
  CellLight sum = a;
  sum += b;
  return 0.5 * sum;
}

/// A leaf of the union of both fields' trees: 3 or 4 corners, as its root has them.
using ElementCell = std::span<const CellCorner>;

/// Points are the vertices of the mesh, then those in the middle of edges. An edge is known by its
/// ends alone, whichever patches it borders: where one of them is cut at its middle, all may know.
class ElementCells {
 public:
  /// Keeps `elements` by reference: of 1 or 3 bands.
  ElementCells(const PatchMesh& mesh, const Elements& elements);

  const Vec3& position(Index point) const { return positions_[point]; }
  /// Whether both fields say what falls on the root.
  bool isEvaluated(std::size_t root) const;
  /// Calls `leaf` for the cells of a root that was evaluated, always in one order.
  void forCells(std::size_t root, const std::function<void(ElementCell)>& leaf) const;
  /// The point in the middle of the edge between two points where some cell is cut there; else
  /// kNone.
  Index middle(Index a, Index b) const;

 private:
  /// A part of a root that one field has: its element, or none where the field is coarser.
  struct Branch {
    Index element = kNone;
    std::array<Vec3, 4> value{};
  };
  struct Node {
    std::array<Branch, 2> field;  ///< direct, indirect
    std::array<Index, 4> point{};
    std::size_t corners = 0;
  };
  using Cut = std::function<Index(Index, Index)>;

  const ElementField& field(std::size_t which) const {
    return which == 0 ? elements_.direct : elements_.indirect;
  }
  Vec3 valueAt(std::size_t which, Index vertex) const;
  Branch rootBranch(std::size_t which, std::size_t root) const;
  bool isCut(std::size_t which, const Branch& branch) const;
  std::array<Branch, 4> partsOfBranch(std::size_t which, const Branch& branch,
                                      std::size_t corners) const;
  void descend(const Node& node, const Cut& middle,
               const std::function<void(ElementCell)>& leaf) const;
  void forCellsOf(std::size_t root, const Cut& middle,
                  const std::function<void(ElementCell)>& leaf) const;
  Index cutEdge(Index a, Index b);

  const Elements& elements_;
  std::vector<Vec3> positions_;
  std::unordered_map<std::uint64_t, Index> middles_;  ///< by both ends
};

}  // namespace radiosity
