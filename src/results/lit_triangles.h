// The triangles of a lit mesh, with radiosity at their corners: those of elements where there are
// some, else those of patches.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "elements/element_cells.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/render.h"

namespace radiosity {

/// A corner of a triangle. Corners at one place have the same point.
struct LitCorner {
  Index point = 0;
  Vec3 radiosity{0.0};  ///< W/m^2
};

/// The triangles of patches, one patch after the other. No corner of a triangle lies inside an edge
/// of another, unless the mesh has such T-junctions. Elements on a smooth side of one material have
/// the same radiosity at common points, to the bit.
class LitTriangles {
 public:
  /// Radiosity of patches (N * 3) and at their corners (mesh.corners.size() * 3). Keeps all by
  /// reference. `elements`: light with elements, which replace patches where they were evaluated;
  /// null: none.
  LitTriangles(const PatchMesh& mesh, std::span<const double> patches,
               std::span<const double> corners, const SurfaceLight* elements = nullptr);

  /// Appends the triangles of a patch, three corners each, counter-clockwise seen from its side.
  void append(Index patch, std::vector<LitCorner>& out);
  const Vec3& position(Index point) const;

 private:
  /// B = emission + reflectance * irradiance.
  struct Material {
    Vec3 emission{0.0};
    Vec3 reflectance{1.0};
    Vec3 radiosity(const CellLight& light) const {
      return emission + reflectance * (light.direct + light.indirect);
    }
  };

  bool hasElements(Index patch) const;
  Material materialOf(Index patch) const;
  Vec3 cornerValue(Index patch, Index vertex) const;
  void appendCell(ElementCell cell, const Material& material, std::vector<LitCorner>& out);
  void appendEdge(const CellCorner& from, const CellCorner& to);
  CellCorner middleOf(ElementCell cell);

  const PatchMesh& mesh_;
  std::span<const double> patches_;
  std::span<const double> corners_;
  const SurfaceLight* light_;
  std::optional<ElementCells> cells_;
  std::vector<Vec3> middles_;     ///< of cells that are cut from there; points from the last one
  std::vector<CellCorner> ring_;  ///< of the present cell: its corners and the points on its edges
};

}  // namespace radiosity
