// Patch meshes made by hand: grids of parallelograms, for tests of rooms that only read a mesh.
#pragma once

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <string>
#include <tuple>

#include "radiosity/patch_mesh.h"

namespace radiosity::test {

/// Builds a PatchMesh patch by patch; equal points become one vertex. `polygon` numbers planar
/// polygons; PlanarPolygons itself stays empty (nothing here rasterises it).
class QuadMesh {
 public:
  /// nu x nv parallelograms over origin + [0,1] u + [0,1] v, front along u x v.
  void grid(const std::string& surface, Vec3 origin, Vec3 u, Vec3 v, int nu = 1, int nv = 1,
            bool two_sided = false) {
    const auto at = [&](int i, int j) {
      return origin + u * (double(i) / nu) + v * (double(j) / nv);
    };
    for (int j = 0; j < nv; ++j) {
      for (int i = 0; i < nu; ++i) {
        patch(surface, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, two_sided);
      }
    }
    ++polygon_;
  }

  /// The six faces of a box, fronts outward, or inward for a room; n x n patches each.
  void box(const std::string& surface, Vec3 low, Vec3 high, int n, bool inward = false) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 u(0.0), v(0.0), w(0.0);
      u[(axis + 1) % 3] = (high - low)[(axis + 1) % 3];
      v[(axis + 2) % 3] = (high - low)[(axis + 2) % 3];
      w[axis] = (high - low)[axis];
      if (inward) std::swap(u, v);
      grid(surface, low + w, u, v, n, n);
      grid(surface, low, v, u, n, n);
    }
  }

  /// One convex planar patch.
  void patch(const std::string& surface, const std::vector<Vec3>& outline, bool two_sided = false) {
    Planned p;
    for (const Vec3& v : outline) p.corners.push_back(vertex(v));
    const auto found = std::find(mesh_.surface_names.begin(), mesh_.surface_names.end(), surface);
    p.surface = Index(found - mesh_.surface_names.begin());
    if (found == mesh_.surface_names.end()) mesh_.surface_names.push_back(surface);
    p.polygon = polygon_;
    planned_.push_back(p);
    if (two_sided) backs_.push_back(planned_.size() - 1);
  }

  /// The mesh, its fronts in the order given by `order` (a permutation), or as they came.
  PatchMesh build(std::vector<std::size_t> order = {}) const {
    PatchMesh mesh = mesh_;
    mesh.corner_offset = mesh.piece_offset = {0};
    if (order.empty()) {
      order.resize(planned_.size());
      std::iota(order.begin(), order.end(), std::size_t(0));
    }
    std::vector<Index> in_surface(planned_.size());
    std::vector<Index> used(mesh.surface_names.size(), 0);
    for (std::size_t k = 0; k < planned_.size(); ++k) in_surface[k] = used[planned_[k].surface]++;
    std::vector<Index> placed(planned_.size());
    for (const std::size_t k : order) {
      placed[k] = Index(mesh.size());
      append(mesh, planned_[k], in_surface[k], 0, kNone);
    }
    for (const std::size_t k : backs_) {
      Planned back = planned_[k];
      std::reverse(back.corners.begin(), back.corners.end());
      mesh.twin[placed[k]] = Index(mesh.size());
      append(mesh, back, in_surface[k], 1, placed[k]);
    }
    return mesh;
  }

  std::size_t patchCount() const { return planned_.size(); }

 private:
  struct Planned {
    std::vector<Index> corners;
    Index surface = 0;
    Index polygon = 0;
  };

  Index vertex(const Vec3& v) {
    const auto [it, added] =
        vertices_.try_emplace(std::tuple(v.x, v.y, v.z), Index(mesh_.vertices.size()));
    if (added) mesh_.vertices.push_back(v);
    return it->second;
  }

  static void append(PatchMesh& mesh, const Planned& p, Index in_surface, int side, Index twin) {
    Vec3 area(0.0);
    Vec3 moment(0.0);
    double total = 0;
    const auto& c = p.corners;
    const Vec3& a = mesh.vertices[c[0]];
    for (std::size_t k = 1; k + 1 < c.size(); ++k) {
      const Vec3 cross = glm::cross(mesh.vertices[c[k]] - a, mesh.vertices[c[k + 1]] - a) * 0.5;
      area += cross;
      total += glm::length(cross);
      moment += (a + mesh.vertices[c[k]] + mesh.vertices[c[k + 1]]) * (glm::length(cross) / 3);
      mesh.pieces.push_back({c[0], c[k], c[k + 1]});
    }
    mesh.piece_offset.push_back(mesh.pieces.size());
    mesh.corners.insert(mesh.corners.end(), c.begin(), c.end());
    mesh.corner_offset.push_back(mesh.corners.size());
    mesh.centroid.push_back(total > 0 ? moment / total : a);
    mesh.normal.push_back(total > 0 ? glm::normalize(area) : Vec3(0.0));
    mesh.area.push_back(total);
    mesh.polygon.push_back(p.polygon);
    mesh.surface.push_back(p.surface);
    mesh.index_in_surface.push_back(in_surface);
    mesh.source_face.push_back(p.polygon);
    mesh.side.push_back(std::uint8_t(side));
    mesh.twin.push_back(twin);
  }

  PatchMesh mesh_;
  std::vector<Planned> planned_;
  std::vector<std::size_t> backs_;
  std::map<std::tuple<double, double, double>, Index> vertices_;
  Index polygon_ = 0;
};

}  // namespace radiosity::test
