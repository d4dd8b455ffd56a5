// Groups the corners at each vertex by the smooth sides of the sheets that meet there.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <tuple>

#include "radiosity/patch_mesh.h"

namespace radiosity {
namespace {

/// One patch at a vertex.
struct Incidence {
  Index patch;
  std::size_t corner;  ///< into mesh.corners
  Index before;        ///< outline neighbours of the vertex
  Index after;
};

/// The corners at each vertex, CSR.
struct VertexFans {
  std::vector<std::size_t> begin;
  std::vector<Incidence> incidences;
};

VertexFans vertexFans(const PatchMesh& mesh) {
  VertexFans fans;
  fans.begin.assign(mesh.vertices.size() + 1, 0);
  for (const Index v : mesh.corners) ++fans.begin[v + 1];
  std::partial_sum(fans.begin.begin(), fans.begin.end(), fans.begin.begin());
  fans.incidences.resize(mesh.corners.size());
  std::vector<std::size_t> next(fans.begin.begin(), fans.begin.end() - 1);
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const auto outline = mesh.outline(i);
    const std::size_t n = outline.size();
    for (std::size_t k = 0; k < n; ++k) {
      fans.incidences[next[outline[k]]++] = {Index(i), mesh.corner_offset[i] + k,
                                             outline[(k + n - 1) % n], outline[(k + 1) % n]};
    }
  }
  return fans;
}

/// Groups the corners at one vertex.
class Fan {
 public:
  Fan(const PatchMesh& mesh, double cosine) : mesh_(mesh), cosine_(cosine) {}

  void append(std::span<const Incidence> at, CornerGroups& groups) {
    at_.assign(at.begin(), at.end());
    // This order does not depend on the order of the patches in the mesh.
    std::sort(at_.begin(), at_.end(),
              [&](const Incidence& a, const Incidence& b) { return key(a) < key(b); });
    link();
    for (std::size_t root = 0; root < at_.size(); ++root) {
      if (find(root) != root) continue;
      for (std::size_t k = root; k < at_.size(); ++k) {
        if (find(k) != root) continue;
        groups.of_corner[at_[k].corner] = Index(groups.size());
        groups.corners.push_back(at_[k].corner);
        groups.patches.push_back(at_[k].patch);
      }
      groups.begin.push_back(groups.corners.size());
    }
  }

 private:
  std::tuple<Index, Index, int, std::size_t> key(const Incidence& a) const {
    return {mesh_.surface[a.patch], mesh_.index_in_surface[a.patch], mesh_.side[a.patch], a.corner};
  }

  /// Whether two patches share an edge in opposite directions and are the same side of one sheet.
  bool smooth(Index a, Index b) const {
    if (mesh_.surface[a] != mesh_.surface[b] || mesh_.twin[a] == b) return false;
    if (!(mesh_.area[a] > 0) || !(mesh_.area[b] > 0)) return false;
    return mesh_.polygon[a] == mesh_.polygon[b] ||
           glm::dot(mesh_.normal[a], mesh_.normal[b]) >= cosine_;
  }

  /// Whether no other patch touches the edge to `neighbour` that patches a and b share. If a wall
  /// stands on a floor, the floor before and behind it have different light.
  bool isFree(Index neighbour, Index a, Index b) const {
    return std::all_of(at_.begin(), at_.end(), [&](const Incidence& other) {
      const Index p = other.patch;
      return (other.before != neighbour && other.after != neighbour) || p == a || p == b ||
             mesh_.twin[a] == p || mesh_.twin[b] == p || !(mesh_.area[p] > 0);
    });
  }

  /// Joins corners whose patches are smooth neighbours across an edge that ends at the vertex.
  void link() {
    root_.resize(at_.size());
    std::iota(root_.begin(), root_.end(), std::size_t(0));
    for (std::size_t k = 1; k < at_.size(); ++k) {
      if (at_[k].patch == at_[k - 1].patch) join(k, k - 1);  // an outline that touches itself
    }
    ends_.clear();
    for (std::size_t k = 0; k < at_.size(); ++k) ends_.push_back({at_[k].after, k});
    std::sort(ends_.begin(), ends_.end());
    for (std::size_t k = 0; k < at_.size(); ++k) {
      auto e =
          std::lower_bound(ends_.begin(), ends_.end(), std::pair(at_[k].before, std::size_t(0)));
      for (; e != ends_.end() && e->first == at_[k].before; ++e) {
        const Index other = at_[e->second].patch;
        if (smooth(at_[k].patch, other) && isFree(e->first, at_[k].patch, other)) {
          join(k, e->second);
        }
      }
    }
  }

  std::size_t find(std::size_t k) {
    while (root_[k] != k) k = root_[k] = root_[root_[k]];
    return k;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    root_[std::max(a, b)] = std::min(a, b);  // the root is the first of its group
  }

  const PatchMesh& mesh_;
  double cosine_;
  std::vector<Incidence> at_;
  std::vector<std::size_t> root_;
  std::vector<std::pair<Index, std::size_t>> ends_;  ///< (vertex after, corner), sorted
};

}  // namespace

CornerGroups cornerGroups(const PatchMesh& mesh, double crease) {
  CornerGroups groups;
  groups.of_corner.resize(mesh.corners.size());
  groups.corners.reserve(mesh.corners.size());
  groups.patches.reserve(mesh.corners.size());
  groups.begin.push_back(0);
  const VertexFans fans = vertexFans(mesh);
  const std::span<const Incidence> all(fans.incidences);
  Fan fan(mesh, std::cos(crease * std::numbers::pi / 180));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    fan.append(all.subspan(fans.begin[v], fans.begin[v + 1] - fans.begin[v]), groups);
  }
  return groups;
}

}  // namespace radiosity
