// A view scene as a GPU reads it: plain arrays of numbers without padding.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

/// ViewPolygon. Sides: front, back; `grid`: into GpuScene::grids, or -1 if all of a side is `item`.
struct GpuPolygon {
  std::array<double, 3> normal, origin;
  std::uint32_t corner_begin, corner_end;  ///< into GpuScene::corners
  std::array<std::int32_t, 2> item, grid;
};

/// PatchGrid. A node's children are nodes of the same grid, counted from its first.
struct GpuGrid {
  std::array<double, 3> u_axis, v_axis;
  double u_offset, v_offset;
  std::int32_t columns, rows;
  std::int32_t first_cell;  ///< into GpuScene::cells
  std::int32_t first_node;  ///< into GpuScene::nodes
};

/// CellNode.
struct GpuNode {
  float a, b, c;
  std::int32_t inside, outside;
};

/// Corners (into GpuScene::vertices) and polygon.
using GpuTriangle = std::array<std::uint32_t, 4>;

static_assert(sizeof(GpuPolygon) == 72 && sizeof(GpuGrid) == 80 && sizeof(GpuNode) == 20 &&
              sizeof(Vec3) == 24);

/// A rasteriser of a GPU moves vertices to a grid of its own, 1/256 of a pixel or so. Neighbours
/// that share their vertices still meet. If one has a vertex in the middle of the other's edge, a
/// pixel between the two could be lost, so triangles are cut at all vertices on their edges.
struct GpuScene {
  /// `mesh`: the one that `scene` was made from.
  GpuScene(const ViewScene& scene, const PatchMesh& mesh);

  double coincidence;   ///< ViewScene::coincidence
  std::uint32_t items;  ///< ViewScene::items; the sky counts as item `items`
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corners;  ///< of polygons, into vertices
  std::vector<GpuPolygon> polygons;    ///< as in ViewScene
  std::vector<GpuTriangle> triangles;  ///< in the polygons' order
  std::vector<GpuGrid> grids;
  std::vector<std::int32_t> cells;  ///< items; in grids, values below 0 are ~(node of the grid)
  std::vector<GpuNode> nodes;

 private:
  void addGrids(const ViewScene& scene);
  void addPolygons(const ViewScene& scene);
};

}  // namespace radiosity
