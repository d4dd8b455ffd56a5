#include "formfactor/view_triangles.h"

#include <optional>

#include "base/parallel.h"

namespace radiosity {

ViewTriangles::ViewTriangles(const ViewScene& scene, const PatchMesh& mesh)
    : vertices(scene.vertices) {
  std::vector<std::optional<std::vector<std::array<Index, 3>>>> of_polygon(scene.polygons.size());
  parallelFor(of_polygon.size(), 64,
              [&](std::size_t p) { of_polygon[p] = scene.trianglesOf(scene.polygons[p]); });
  std::vector<Index> without_triangles;
  for (Index p = 0; p < of_polygon.size(); ++p) {
    if (const auto& found = of_polygon[p]) {
      triangles.insert(triangles.end(), found->begin(), found->end());
      polygon_of.insert(polygon_of.end(), found->size(), p);
    } else {
      without_triangles.push_back(p);
    }
  }
  if (!without_triangles.empty()) addTiles(scene, mesh, without_triangles);
}

void ViewTriangles::addTiles(const ViewScene& scene, const PatchMesh& mesh,
                             const std::vector<Index>& without_triangles) {
  std::vector<Index> place(mesh.polygons.size(), kNone);  // of polygons without triangles
  for (const Index p : without_triangles) place[scene.polygons[p].source] = p;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    // A back has the tiles of its front.
    const Index polygon = mesh.polygon[i];
    if (polygon == kNone || place[polygon] == kNone || mesh.side[i] != 0) continue;
    for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
      const auto first = Index(vertices.size());
      for (const Index v : mesh.pieces[t]) vertices.push_back(mesh.vertices[v] * scene.scale);
      triangles.push_back({first, first + 1, first + 2});
      polygon_of.push_back(place[polygon]);
    }
  }
}

}  // namespace radiosity
