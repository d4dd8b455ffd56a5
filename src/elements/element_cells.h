// The union of both fields' elements, for the export of surfaces: the cells that neither field cuts
// further, and their corner points.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <unordered_map>
#include <vector>

#include "radiosity/elements.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Irradiance of both fields, W/m^2; one band is repeated three times. The fields stay apart until
/// the last interpolation, so that both sides of an edge have the same bits.
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

/// A leaf of the union of both fields' trees: 3 or 4 corners, like its root.
using ElementCell = std::span<const CellCorner>;

/// Points are the vertices of the mesh, then the middles of edges. An edge is identified by its
/// ends alone, for all patches on it: if one patch cuts it at its middle, the others find out.
class ElementCells {
 public:
  /// Keeps `elements` by reference: of 1 or 3 bands.
  ElementCells(const PatchMesh& mesh, const Elements& elements);

  const Vec3& position(Index point) const { return positions_[point]; }
  /// Whether both fields have light on the root.
  bool isEvaluated(std::size_t root) const;
  /// Calls `leaf` for the cells of a root that was evaluated, always in one order.
  void forCells(std::size_t root, const std::function<void(ElementCell)>& leaf) const;
  /// The point in the middle of the edge between two points if a cell is cut there; else kNone.
  Index middle(Index a, Index b) const;

 private:
  /// The element of one field that is a part of a root; none if the field is coarser.
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
