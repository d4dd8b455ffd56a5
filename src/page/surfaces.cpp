#include "page/surfaces.h"

#include <algorithm>
#include <utility>

namespace radiosity::page {

namespace {

/// Appends shading vertices one after the other.
class ShadingBuilder {
 public:
  explicit ShadingBuilder(const PatchMesh& mesh) : mesh_(mesh) { made_.begin.push_back(0); }

  /// Appends a vertex. A patch counts once, although it may have several adjacent corners in the
  /// group.
  void appendGroup(std::span<const Index> patches) {
    const std::size_t first = made_.patch.size();
    double area = 0;
    for (const Index patch : patches) {
      if (made_.patch.size() > first && made_.patch.back() == patch) continue;
      made_.patch.push_back(patch);
      area += mesh_.area[patch];
    }
    for (std::size_t k = first; k < made_.patch.size(); ++k) {
      // If all patches lack area, the first has all the weight.
      const double share = area > 0 ? mesh_.area[made_.patch[k]] / area : double(k == first);
      made_.weight.push_back(float(share));
    }
    made_.begin.push_back(std::uint32_t(made_.patch.size()));
  }

  /// Gives every corner of every triangle its group's vertex or, within a patch, the patch's own.
  ShadingVertices run(const CornerGroups& groups) {
    for (std::size_t g = 0; g < groups.size(); ++g) appendGroup(groups.patchesOf(g));
    made_.corner.reserve(3 * mesh_.pieces.size());
    for (std::size_t i = 0; i < mesh_.size(); ++i) {
      const auto outline = mesh_.outline(i);
      std::uint32_t inner = kNone;
      for (std::size_t t = mesh_.piece_offset[i]; t < mesh_.piece_offset[i + 1]; ++t) {
        for (const Index vertex : mesh_.pieces[t]) {
          const auto found = std::find(outline.begin(), outline.end(), vertex);
          if (found == outline.end() && inner == kNone) {
            inner = std::uint32_t(made_.begin.size() - 1);
            const auto patch = Index(i);
            appendGroup({&patch, 1});
          }
          const auto k = std::size_t(found - outline.begin());
          made_.corner.push_back(
              found == outline.end() ? inner : groups.of_corner[mesh_.corner_offset[i] + k]);
        }
      }
    }
    return std::move(made_);
  }

 private:
  const PatchMesh& mesh_;
  ShadingVertices made_;
};

std::vector<std::uint32_t> patchOfTriangles(const PatchMesh& mesh) {
  std::vector<std::uint32_t> patch;
  patch.reserve(mesh.pieces.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    patch.insert(patch.end(), mesh.piece_offset[i + 1] - mesh.piece_offset[i], std::uint32_t(i));
  }
  return patch;
}

}  // namespace

ShadingVertices shadingVertices(const PatchMesh& mesh, double crease) {
  return ShadingBuilder(mesh).run(cornerGroups(mesh, crease));
}

std::vector<std::uint32_t> outlineEdges(const PatchMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      edges.emplace_back(std::minmax(outline[k], outline[(k + 1) % outline.size()]));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::uint32_t> flat;
  flat.reserve(2 * edges.size());
  for (const auto& [a, b] : edges) flat.insert(flat.end(), {a, b});
  return flat;
}

std::vector<float> packed(std::span<const Vec3> points, const Vec3& origin) {
  std::vector<float> flat;
  flat.reserve(3 * points.size());
  for (const Vec3& point : points) {
    const Vec3 p = point - origin;
    flat.insert(flat.end(), {float(p.x), float(p.y), float(p.z)});
  }
  return flat;
}

void addSurfaces(const PatchMesh& mesh, double crease, const Vec3& origin, Container& container) {
  std::vector<std::uint32_t> triangles;
  triangles.reserve(3 * mesh.pieces.size());
  for (const auto& piece : mesh.pieces)
    triangles.insert(triangles.end(), piece.begin(), piece.end());
  const ShadingVertices shading = shadingVertices(mesh, crease);
  container.add("position", packed(mesh.vertices, origin));
  container.add("patch_triangle", triangles);
  container.add("triangle_patch", patchOfTriangles(mesh));
  container.add("triangle_corner", shading.corner);
  container.add("shading_begin", shading.begin);
  container.add("shading_patch", shading.patch);
  container.add("shading_weight", shading.weight);
  container.add("edge", outlineEdges(mesh));
}

}  // namespace radiosity::page
