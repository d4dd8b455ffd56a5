#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/geometry/box_tree.h"
#include "base/parallel.h"
#include "mesh/edge_key.h"
#include "mesh/patches/mesh_figures.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

namespace {

constexpr std::size_t kEdgesAtATime = 1024;  // for each task of a thread

struct Edges {
  std::vector<std::array<Index, 2>> ends;
  std::vector<Index> patch;  ///< a patch with the edge
  double mean_length = 0;
};

Edges distinctEdges(const PatchMesh& mesh) {
  struct Side {
    std::uint64_t key;
    std::size_t corner;  ///< where it begins
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(mesh.corners.size());
  std::vector<std::array<Index, 2>> ends;
  ends.reserve(mesh.corners.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      ends.push_back({outline[k], outline[(k + 1) % outline.size()]});
      sides.push_back({edgeKey(ends.back()[0], ends.back()[1]), ends.size() - 1});
    }
  }
  parallelSort(sides);
  std::vector<char> is_first(ends.size(), 0);
  for (std::size_t k = 0; k < sides.size(); ++k) {
    is_first[sides[k].corner] = k == 0 || sides[k].key != sides[k - 1].key;
  }
  Edges edges;
  std::size_t corner = 0;
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    for (const std::size_t end = corner + mesh.outline(i).size(); corner < end; ++corner) {
      if (!is_first[corner]) continue;
      const auto& [a, b] = ends[corner];
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
  const double longest_step = std::max(edges.mean_length, 4 * tolerance);
  std::vector<Index> corners;
  std::vector<Box3> places;
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const Index vertex : mesh.corners) {
    if (used[vertex]) continue;
    used[vertex] = true;
    corners.push_back(vertex);
    places.push_back({mesh.vertices[vertex], mesh.vertices[vertex]});
  }
  const BoxTree tree(places);

  const auto lookAlong = [&](std::size_t e, std::vector<Index>& found) {
    const auto [from, to] = edges.ends[e];
    const Vec3& a = mesh.vertices[from];
    const Vec3 along = mesh.vertices[to] - a;
    const double length = glm::length(along);
    if (length <= 2 * tolerance) return;
    // We walk along long edges in steps, with a small box each; a point belongs to the step onto
    // which it projects.
    const double steps = std::ceil(length / longest_step);
    for (double step = 0; step < steps; ++step) {
      const Vec3 p = a + along * (step / steps);
      const Vec3 q = a + along * ((step + 1) / steps);
      const Box3 beside{glm::min(p, q) - tolerance, glm::max(p, q) + tolerance};
      tree.query(beside, [&](Index k) {
        const Index vertex = corners[k];
        if (vertex == from || vertex == to) return true;
        const Vec3 away = mesh.vertices[vertex] - a;
        const double t = glm::dot(away, along) / (length * length);
        if (std::floor(t * steps) != step) return true;
        if (t * length <= tolerance || (1 - t) * length <= tolerance) return true;
        if (glm::length(away - t * along) <= tolerance) found.push_back(edges.patch[e]);
        return true;
      });
    }
  };
  std::vector<std::vector<Index>> found((edges.ends.size() + kEdgesAtATime - 1) / kEdgesAtATime);
  parallelFor(found.size(), 1, [&](std::size_t block) {
    const std::size_t end = std::min(edges.ends.size(), (block + 1) * kEdgesAtATime);
    for (std::size_t e = block * kEdgesAtATime; e < end; ++e) lookAlong(e, found[block]);
  });
  for (const auto& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

std::size_t countTJunctions(const PatchMesh& mesh, double tolerance) {
  return patchesAtTJunctions(mesh, tolerance).size();
}

}  // namespace radiosity
