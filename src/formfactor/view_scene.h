// The mesh as an eye needs it: the polygons that occlude, and the item that each visible point
// counts for.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formfactor/patch_grid.h"
#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The item that a side of a polygon counts for. Items are 0 to N-1: patch; N + s: the black back
/// of surface s (a side without patches).
struct PolygonSide {
  std::uint32_t item = kNone;  ///< everywhere, if `grid` is kNone
  Index grid = kNone;          ///< into ViewScene::grids: look the patch up there
};

struct ViewPolygon {
  Index source;              ///< polygon of the mesh
  std::uint32_t loop_begin;  ///< loops [loop_begin, loop_end)
  std::uint32_t loop_end;
  Vec3 normal;                      ///< unit, of the front
  Vec3 origin;                      ///< a point of the plane
  std::array<PolygonSide, 2> side;  ///< front, back
};

/// Planar polygons with their vertices packed, in an order that does not depend on how patches or
/// polygons are numbered: by surface name and index within the surface. Coordinates are the
/// mesh's times a power of two that brings the scene to a size of about 1, so that single
/// precision depths neither overflow nor depend on the scene's unit; it changes no bit of any
/// mantissa.
struct ViewScene {
  explicit ViewScene(const PatchMesh& mesh);

  std::size_t patches;  ///< N
  std::size_t items;    ///< N + surfaces
  double scale;         ///< power of two
  /// Corners no farther than this from the eye's plane lie in it, vertices no farther from an edge
  /// on it: the mesh's default coincidence, 1e-7 of the scene's diagonal, scaled.
  double coincidence;
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> loop_offset;  ///< L + 1, into corners
  std::vector<std::uint32_t> corners;      ///< into vertices
  std::vector<ViewPolygon> polygons;
  std::vector<PatchGrid> grids;
  /// The item that each numbered cell counts for: cell k < items is item k, the next one is the
  /// sky, which counts as item `items`; then come the cells of all grids, as in PatchGrid::cells().
  std::vector<std::int32_t> cells;
  std::vector<std::int32_t> first_cell;  ///< of each grid
  std::int32_t skyCell() const { return std::int32_t(items); }

  std::size_t bytes() const;

  /// Corners of loop `l`, into vertices.
  std::span<const Index> loop(std::uint32_t l) const {
    return std::span(corners).subspan(loop_offset[l], loop_offset[l + 1] - loop_offset[l]);
  }

  /// Triangles between the vertices that tile the polygon, counter-clockwise about its normal.
  /// Nothing if its loops cross.
  std::optional<std::vector<std::array<Index, 3>>> trianglesOf(const ViewPolygon& polygon) const;

 private:
  std::vector<Index> packVertices(const PatchMesh& mesh);
  void addPolygons(const PatchMesh& mesh);
  void addSides(const PatchMesh& mesh);
  void numberCells();
};

/// The convex pieces of a patch: its outline if that is convex, else its triangles.
void appendPieces(const PatchMesh& mesh, std::size_t patch, double scale,
                  std::vector<GridPiece>& pieces);

}  // namespace radiosity
