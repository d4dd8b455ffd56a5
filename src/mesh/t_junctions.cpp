#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <unordered_map>
#include <unordered_set>

#include "mesh/edge_key.h"
#include "mesh/mesh_figures.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

namespace {

/// Points by the cell of a cubic grid they lie in.
class PointGrid {
 public:
  PointGrid(const PatchMesh& mesh, const Vec3& lower, double cell)
      : mesh_(mesh), lower_(lower), cell_(cell) {}

  void add(Index vertex) {
    const auto c = cellOf(mesh_.vertices[vertex]);
    cells_[keyOf(c[0], c[1], c[2])].push_back(vertex);
  }

  /// Calls visit(vertex) once for every point in the cells between `low` and `high`.
  template <class Visit>
  void forBox(const Vec3& low, const Vec3& high, const Visit& visit) const {
    const auto a = cellOf(low);
    const auto b = cellOf(high);
    for (long z = a[2]; z <= b[2]; ++z) {
      for (long y = a[1]; y <= b[1]; ++y) {
        for (long x = a[0]; x <= b[0]; ++x) {
          const auto found = cells_.find(keyOf(x, y, z));
          if (found == cells_.end()) continue;
          for (const Index vertex : found->second) {
            // Two cells of the box may share a key.
            if (cellOf(mesh_.vertices[vertex]) == std::array<long, 3>{x, y, z}) visit(vertex);
          }
        }
      }
    }
  }

 private:
  std::array<long, 3> cellOf(const Vec3& p) const {
    const Vec3 c = glm::floor((p - lower_) / cell_);
    return {long(c.x), long(c.y), long(c.z)};
  }
  static std::uint64_t keyOf(long x, long y, long z) {
    return std::uint64_t(x) * 73856093u ^ std::uint64_t(y) * 19349663u * 4099u ^
           std::uint64_t(z) * 83492791u * 16777259u;
  }

  const PatchMesh& mesh_;
  Vec3 lower_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<Index>> cells_;
};

struct Edges {
  std::vector<std::array<Index, 2>> ends;
  std::vector<Index> patch;  ///< one that has the edge
  double mean_length = 0;
};

Edges distinctEdges(const PatchMesh& mesh) {
  Edges edges;
  std::unordered_set<std::uint64_t> seen;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Index a = outline[k];
      const Index b = outline[(k + 1) % outline.size()];
      if (!seen.insert(edgeKey(a, b)).second) continue;
      edges.ends.push_back({a, b});
      edges.patch.push_back(Index(i));
      edges.mean_length += glm::length(mesh.vertices[b] - mesh.vertices[a]);
    }
  }
  if (!edges.ends.empty()) edges.mean_length /= double(edges.ends.size());
  return edges;
}

}  // namespace

std::vector<Index> patchesAtTJunctions(const PatchMesh& mesh, double tolerance) {
  const Edges edges = distinctEdges(mesh);
  std::vector<Index> out;
  if (!(edges.mean_length > 0)) return out;
  Vec3 lower = mesh.vertices[edges.ends[0][0]];
  for (const Vec3& vertex : mesh.vertices) lower = glm::min(lower, vertex);
  const double cell = std::max(edges.mean_length, 4 * tolerance);
  PointGrid grid(mesh, lower, cell);
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Index vertex : mesh.corners) {
    if (!used[vertex]) grid.add(vertex);
    used[vertex] = true;
  }

  for (std::size_t e = 0; e < edges.ends.size(); ++e) {
    const auto [from, to] = edges.ends[e];
    const Vec3& a = mesh.vertices[from];
    const Vec3 along = mesh.vertices[to] - a;
    const double length = glm::length(along);
    if (length <= 2 * tolerance) continue;
    // Long edges are walked in steps of a cell; a point belongs to the step it projects onto.
    const double steps = std::ceil(length / cell);
    for (double step = 0; step < steps; ++step) {
      const Vec3 p = a + along * (step / steps);
      const Vec3 q = a + along * ((step + 1) / steps);
      grid.forBox(glm::min(p, q) - tolerance, glm::max(p, q) + tolerance, [&](Index vertex) {
        if (vertex == from || vertex == to) return;
        const Vec3 away = mesh.vertices[vertex] - a;
        const double t = glm::dot(away, along) / (length * length);
        if (std::floor(t * steps) != step) return;
        if (t * length <= tolerance || (1 - t) * length <= tolerance) return;
        if (glm::length(away - t * along) <= tolerance) out.push_back(edges.patch[e]);
      });
    }
  }
  return out;
}

std::size_t countTJunctions(const PatchMesh& mesh, double tolerance) {
  return patchesAtTJunctions(mesh, tolerance).size();
}

}  // namespace radiosity
