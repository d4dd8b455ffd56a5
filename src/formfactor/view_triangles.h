// The polygons of a view scene as triangles, for code that draws or traces no other shapes.
#pragma once

#include <array>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

struct ViewTriangles {
  /// `mesh`: the one that `scene` was made from. A polygon whose outlines cross is taken as the
  /// triangles that tile its patches.
  ViewTriangles(const ViewScene& scene, const PatchMesh& mesh);

  /// The vertices of the ViewScene and of such tiles, in its coordinates.
  std::vector<Vec3> vertices;
  std::vector<std::array<Index, 3>> triangles;  ///< corners, into vertices
  std::vector<Index> polygon_of;  ///< position in ViewScene::polygons of each triangle

 private:
  void addTiles(const ViewScene& scene, const PatchMesh& mesh,
                const std::vector<Index>& without_triangles);
};

}  // namespace radiosity
