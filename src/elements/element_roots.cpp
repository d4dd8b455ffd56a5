#include "elements/element_roots.h"

#include <glm/geometric.hpp>

namespace radiosity {
namespace {

bool isConvexQuad(const PatchMesh& mesh, std::size_t patch) {
  const auto outline = mesh.outline(patch);
  if (outline.size() != 4) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3& a = mesh.vertices[outline[(k + 3) % 4]];
    const Vec3& b = mesh.vertices[outline[k]];
    const Vec3& c = mesh.vertices[outline[(k + 1) % 4]];
    // With a corner in line with its neighbours the bilinear map would be singular on an edge.
    const double turn = glm::dot(glm::cross(b - a, c - b), mesh.normal[patch]);
    if (!(turn > 1e-3 * glm::distance(a, b) * glm::distance(b, c))) return false;
  }
  return true;
}

}  // namespace

ElementRoots elementRoots(const PatchMesh& mesh) {
  ElementRoots roots;
  roots.of_patch.push_back(0);
  for (Index i = 0; i < mesh.size(); ++i) {
    if (mesh.area[i] > 0 && mesh.polygon[i] != kNone) {
      const auto outline = mesh.outline(i);
      if (isConvexQuad(mesh, i)) {
        roots.patch.push_back(i);
        roots.corner.push_back({outline[0], outline[1], outline[2], outline[3]});
      } else {
        for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
          const auto& piece = mesh.pieces[t];
          roots.patch.push_back(i);
          roots.corner.push_back({piece[0], piece[1], piece[2], kNone});
        }
      }
    }
    roots.of_patch.push_back(roots.size());
  }
  return roots;
}

}  // namespace radiosity
