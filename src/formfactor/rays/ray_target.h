// What rays count for, found from the place on a triangle where they ended.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/cell_tree.h"
#include "formfactor/rays/embree_scene.h"
#include "formfactor/view_scene.h"

namespace radiosity {

/// One side of a triangle: the item (of the ViewScene) that it counts for, or the map from a hit's
/// position (Embree's s and t) to its polygon's grid: u[0] + u[1] s + u[2] t. Vector kernels read
/// it word by word.
struct RayTarget {
  std::array<float, 3> u{};
  std::array<float, 3> v{};
  std::int32_t columns = 0;  ///< 0: no grid
  std::int32_t rows = 0;
  std::int32_t first = 0;  ///< the grid's first cell; without a grid, the item everywhere
  Index polygon = 0;       ///< of the mesh
};

/// Where the lanes of a packet ended.
struct RayEnds {
  alignas(64) std::array<std::int32_t, kRayLanes> entry;  ///< item, or ~node of a tree
  alignas(64) std::array<float, kRayLanes> u;             ///< in the grid's coordinates
  alignas(64) std::array<float, kRayLanes> v;
  alignas(64) std::array<Index, kRayLanes> polygon;
};

/// The targets of all triangles of a scene, with the cells and trees of all grids behind them.
class RayTargets {
 public:
  RayTargets(const ViewScene& scene, const EmbreeScene& embree);

  /// `side`: 0 the front, 1 the back; s, t: Embree's. As PolygonSide::item.
  std::uint32_t itemAt(std::uint32_t triangle, int side, float s, float t) const;
  /// The item of an entry of `ends`.
  std::uint32_t itemOf(const RayEnds& ends, std::size_t lane) const {
    const std::int32_t entry = ends.entry[lane];
    return entry >= 0 ? std::uint32_t(entry) : leafOf(entry, ends.u[lane], ends.v[lane]);
  }
  Index polygonOf(std::uint32_t triangle) const { return targets_[2 * triangle].polygon; }

  /// Front and back of each triangle in turn; one, of no triangle, if there are none.
  std::span<const RayTarget> targets() const { return targets_; }
  /// Of all grids. An item if >= 0, else the node ~cell.
  std::span<const std::int32_t> cells() const { return cells_; }
  std::size_t bytes() const {
    return targets_.size() * sizeof(RayTarget) + cells_.size() * sizeof(std::int32_t) +
           nodes_.size() * sizeof(CellNode);
  }

 private:
  struct GridPlace;  // of a grid behind the others
  GridPlace append(const PatchGrid& grid);
  std::uint32_t leafOf(std::int32_t entry, float u, float v) const;

  std::vector<RayTarget> targets_;
  std::vector<std::int32_t> cells_;
  std::vector<CellNode> nodes_;
};

}  // namespace radiosity
