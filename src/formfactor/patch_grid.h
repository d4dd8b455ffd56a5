// Which patch of a planar polygon lies at a point of its plane.
#pragma once

#include <span>
#include <vector>

#include "formfactor/cell_tree.h"
#include "radiosity/base.h"

namespace radiosity {

/// A convex piece of a patch: corners in the plane, either way round.
struct GridPiece {
  std::vector<Vec3> corners;
  std::int32_t item;  ///< the answer of a look-up, >= 0
};

/// A grid in the plane of one polygon, with axes along the edges of its first patch, so that a
/// polygon cut into equal parallelograms has one patch a cell and nothing else to decide. A cell
/// that several patches share holds a small binary tree of lines along their edges; walking it
/// ends at exactly one item for every point, so no point is lost between patches.
///
/// Patches are taken in the order given: give them in an order that does not depend on their
/// numbering. Slivers of less than 1e-6 of a cell and of the patch that reach into a cell through
/// rounding are left out of it; cells are found in 32-bit arithmetic, which is no finer.
class PatchGrid {
 public:
  /// `pieces`: one or more, of non-zero area, disjoint, in a plane through `origin`.
  PatchGrid(std::span<const GridPiece> pieces, const Vec3& origin, const Vec3& normal);

  std::int32_t columns() const { return columns_; }
  std::int32_t rows() const { return rows_; }
  /// Cell row * columns + column holds an item if it is >= 0, else the node ~cell of a tree.
  std::span<const std::int32_t> cells() const { return cells_; }
  /// True if some cell holds a tree.
  bool hasTrees() const { return !nodes_.empty(); }
  const CellNode& node(std::int32_t index) const { return nodes_[std::size_t(index)]; }
  std::span<const CellNode> nodes() const { return nodes_; }
  /// Grid coordinates of a point P of the plane are dot(uAxis, P - origin) + uOffset, and the same
  /// for v. Cells are centred on whole numbers: u runs from -1/2 to columns - 1/2.
  const Vec3& uAxis() const { return u_axis_; }
  const Vec3& vAxis() const { return v_axis_; }
  double uOffset() const { return u_offset_; }
  double vOffset() const { return v_offset_; }
  std::size_t bytes() const {
    return cells_.size() * sizeof(std::int32_t) + nodes_.size() * sizeof(CellNode);
  }

 private:
  void chooseAxes(std::span<const GridPiece> pieces, const Vec3& origin, const Vec3& normal);
  void fillEmptyCells();
  void moveToCellCentres();

  Vec3 u_axis_{0.0};
  Vec3 v_axis_{0.0};
  double u_offset_ = 0;
  double v_offset_ = 0;
  std::int32_t columns_ = 1;
  std::int32_t rows_ = 1;
  std::vector<std::int32_t> cells_;
  std::vector<CellNode> nodes_;
};

}  // namespace radiosity
