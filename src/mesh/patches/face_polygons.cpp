#include "mesh/patches/face_polygons.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <unordered_map>
#include <unordered_set>

#include "mesh/edge_key.h"

namespace radiosity {

namespace {

/// The face along each directed edge; kNone if there are several.
using EdgeFaces = std::unordered_map<std::uint64_t, Index>;

EdgeFaces facesOfEdges(const Scene& scene, std::span<const FaceShape> shapes) {
  EdgeFaces faces;
  for (Index f = 0; f < scene.faceCount(); ++f) {
    if (shapes[f].area == 0) continue;
    const auto outline = scene.face(f);
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const auto [place, is_new] =
          faces.try_emplace(directedKey(outline[k], outline[(k + 1) % outline.size()]), f);
      if (!is_new && place->second != f) place->second = kNone;
    }
  }
  return faces;
}

class FaceMerger {
 public:
  FaceMerger(const Scene& scene, std::span<const FaceShape> shapes, double coincidence)
      : scene_(scene),
        shapes_(shapes),
        coincidence_(coincidence),
        edges_(facesOfEdges(scene, shapes)),
        group_(scene.faceCount(), kNone) {}

  /// The group of every face, numbered by first face; kNone for degenerate ones.
  std::vector<Index> groups(Progress& progress) {
    // We take planes from the largest faces, which define them best.
    std::vector<Index> order(scene_.faceCount());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return shapes_[a].area > shapes_[b].area; });
    Index count = 0;
    for (const Index f : order) {
      progress.check();
      if (shapes_[f].area > 0 && group_[f] == kNone) grow(f, count++);
    }
    std::vector<Index> number(count, kNone);
    Index next = 0;
    for (Index& g : group_) {
      if (g == kNone) continue;
      if (number[g] == kNone) number[g] = next++;
      g = number[g];
    }
    return group_;
  }

 private:
  void grow(Index seed, Index group) {
    group_[seed] = group;
    if (!shapes_[seed].planar) return;
    std::vector<Index> stack = {seed};
    while (!stack.empty()) {
      const Index f = stack.back();
      stack.pop_back();
      const auto outline = scene_.face(f);
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const Index a = outline[k];
        const Index b = outline[(k + 1) % outline.size()];
        const auto neighbour = edges_.find(directedKey(b, a));
        if (neighbour == edges_.end() || edges_.at(directedKey(a, b)) != f) continue;
        const Index g = neighbour->second;
        if (g == kNone || group_[g] != kNone || !continues(seed, g)) continue;
        group_[g] = group;
        stack.push_back(g);
      }
    }
  }

  bool continues(Index seed, Index face) const {
    if (!shapes_[face].planar || scene_.face_surface[face] != scene_.face_surface[seed] ||
        glm::dot(shapes_[face].normal, shapes_[seed].normal) <= 0) {
      return false;
    }
    const Vec3& base = scene_.vertices[scene_.face(seed)[0]];
    return std::ranges::all_of(scene_.face(face), [&](Index v) {
      return std::abs(glm::dot(scene_.vertices[v] - base, shapes_[seed].normal)) <= coincidence_;
    });
  }

  const Scene& scene_;
  std::span<const FaceShape> shapes_;
  double coincidence_;
  EdgeFaces edges_;
  std::vector<Index> group_;
};

/// Makes closed loops of directed edges, of which no two are each other's reverse. If several leave
/// a vertex, any will do: the inside is even-odd.
std::vector<std::vector<Index>> outlineLoops(const std::vector<std::array<Index, 2>>& edges) {
  std::unordered_multimap<Index, std::size_t> leaving;
  for (std::size_t e = edges.size(); e > 0; --e) leaving.emplace(edges[e - 1][0], e - 1);
  std::vector<bool> used(edges.size(), false);
  std::vector<std::vector<Index>> loops;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    if (used[first]) continue;
    auto& loop = loops.emplace_back();
    std::size_t e = first;
    while (!used[e]) {
      used[e] = true;
      loop.push_back(edges[e][0]);
      const auto [begin, end] = leaving.equal_range(edges[e][1]);
      for (auto it = begin; it != end; ++it) {
        if (!used[it->second]) e = it->second;
      }
    }
  }
  return loops;
}

}  // namespace

void mergeFaces(const Scene& scene, std::span<const FaceShape> shapes, double coincidence,
                PatchMesh& mesh, Progress& progress) {
  mesh.polygon = FaceMerger(scene, shapes, coincidence).groups(progress);
  PlanarPolygons& polygons = mesh.polygons;
  polygons.loop_offset = polygons.corner_offset = {0};
  std::vector<std::vector<Index>> members;
  for (Index f = 0; f < scene.faceCount(); ++f) {
    if (mesh.polygon[f] == kNone) continue;
    if (mesh.polygon[f] == members.size()) members.emplace_back();
    members[mesh.polygon[f]].push_back(f);
  }
  for (const auto& faces : members) {
    progress.check();
    std::unordered_set<std::uint64_t> inside;
    for (const Index f : faces) {
      const auto outline = scene.face(f);
      for (std::size_t k = 0; k < outline.size(); ++k) {
        inside.insert(directedKey(outline[k], outline[(k + 1) % outline.size()]));
      }
    }
    std::vector<std::array<Index, 2>> rim;
    Vec3 normal(0.0);
    for (const Index f : faces) {
      normal += shapes[f].area * shapes[f].normal;
      const auto outline = scene.face(f);
      for (std::size_t k = 0; k < outline.size(); ++k) {
        const Index a = outline[k];
        const Index b = outline[(k + 1) % outline.size()];
        if (a != b && inside.count(directedKey(b, a)) == 0) rim.push_back({a, b});
      }
    }
    for (const auto& loop : outlineLoops(rim)) {
      polygons.corners.insert(polygons.corners.end(), loop.begin(), loop.end());
      polygons.corner_offset.push_back(polygons.corners.size());
    }
    polygons.loop_offset.push_back(polygons.corner_offset.size() - 1);
    polygons.normal.push_back(glm::normalize(normal));
    polygons.origin.push_back(scene.vertices[scene.face(faces[0])[0]]);
    polygons.surface.push_back(scene.face_surface[faces[0]]);
    polygons.back_is_patch.push_back(scene.materialOf(faces[0]).two_sided ? 1 : 0);
  }
}

}  // namespace radiosity
