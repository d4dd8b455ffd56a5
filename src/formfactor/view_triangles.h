// The polygons of a view scene as triangles, for what draws or traces no other shapes.
#pragma once

#include <array>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

struct ViewTriangles {
  /// `mesh`: whose ViewScene that is. A polygon whose outlines cross is taken as the triangles that
  /// tile its patches.
  ViewTriangles(const ViewScene& scene, const PatchMesh& mesh);

  /// In the coordinates of the ViewScene: its vertices, and those of such tiles.
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;  ///< corners, into vertices
  std::vector<Index> polygon_of;  ///< position in ViewScene::polygons of each triangle

 private:
  void addTiles(const ViewScene& scene, const PatchMesh& mesh,
                const std::vector<Index>& without_triangles);
};

}  // namespace radiosity
