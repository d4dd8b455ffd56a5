// Patch values -> values at the corners of patches, shared across smooth neighbours.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "radiosity/render.h"

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

/// Groups the corners at one vertex and averages over each group.
class Fan {
 public:
  Fan(const PatchMesh& mesh, std::span<const double> values, int bands, double cosine)
      : mesh_(mesh), values_(values), bands_(bands), cosine_(cosine) {}

  void average(std::span<const Incidence> at, std::vector<double>& result) {
    at_.assign(at.begin(), at.end());
    // Sums are made in an order that the order of the patches in the mesh does not change.
    std::sort(at_.begin(), at_.end(),
              [&](const Incidence& a, const Incidence& b) { return key(a) < key(b); });
    link();
    std::vector<std::size_t> members;
    for (std::size_t root = 0; root < at_.size(); ++root) {
      if (find(root) != root) continue;
      members.clear();
      for (std::size_t k = root; k < at_.size(); ++k) {
        if (find(k) == root) members.push_back(k);
      }
      write(members, result);
    }
  }

 private:
  std::tuple<Index, Index, int, std::size_t> key(const Incidence& a) const {
    return {mesh_.surface[a.patch], mesh_.index_in_surface[a.patch], mesh_.side[a.patch], a.corner};
  }

  /// Two patches that share an edge, oppositely oriented: the same side of one sheet.
  bool smooth(Index a, Index b) const {
    if (mesh_.surface[a] != mesh_.surface[b] || mesh_.twin[a] == b) return false;
    if (!(mesh_.area[a] > 0) || !(mesh_.area[b] > 0)) return false;
    return mesh_.polygon[a] == mesh_.polygon[b] ||
           glm::dot(mesh_.normal[a], mesh_.normal[b]) >= cosine_;
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
        if (smooth(at_[k].patch, at_[e->second].patch)) join(k, e->second);
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

  /// Area-weighted mean over the group's patches, each once, as a difference to the first: a
  /// constant stays that constant to the bit.
  void write(const std::vector<std::size_t>& members, std::vector<double>& result) const {
    const Index first = at_[members[0]].patch;
    for (int b = 0; b < bands_; ++b) {
      const double base = value(first, b);
      double area = 0;
      double sum = 0;
      Index last = kNone;
      for (const std::size_t k : members) {
        const Index patch = at_[k].patch;
        if (patch == last) continue;
        last = patch;
        area += mesh_.area[patch];
        sum += mesh_.area[patch] * (value(patch, b) - base);
      }
      const double mean = area > 0 ? base + sum / area : base;
      for (const std::size_t k : members) result[at_[k].corner * bands_ + b] = mean;
    }
  }

  double value(Index patch, int band) const { return values_[std::size_t(patch) * bands_ + band]; }

  const PatchMesh& mesh_;
  std::span<const double> values_;
  int bands_;
  double cosine_;
  std::vector<Incidence> at_;
  std::vector<std::size_t> root_;
  std::vector<std::pair<Index, std::size_t>> ends_;  ///< (vertex after, corner), sorted
};

}  // namespace

std::vector<double> cornerValues(const PatchMesh& mesh, std::span<const double> values, int bands,
                                 double crease) {
  if (bands < 1 || values.size() != mesh.size() * std::size_t(bands)) {
    throw InputError("cornerValues: " + std::to_string(bands) + " values a patch are needed, " +
                     std::to_string(values.size()) + " were given for " +
                     std::to_string(mesh.size()) + " patches");
  }
  std::vector<double> result(mesh.corners.size() * bands);
  const VertexFans fans = vertexFans(mesh);
  const double cosine = std::cos(crease * std::numbers::pi / 180);
  constexpr std::size_t kBlock = 256;  // vertices that share one Fan's memory
  const std::size_t vertices = mesh.vertices.size();
  parallelFor((vertices + kBlock - 1) / kBlock, 1, [&](std::size_t block) {
    Fan fan(mesh, values, bands, cosine);
    for (std::size_t v = block * kBlock; v < std::min(vertices, (block + 1) * kBlock); ++v) {
      const std::span<const Incidence> all(fans.incidences);
      fan.average(all.subspan(fans.begin[v], fans.begin[v + 1] - fans.begin[v]), result);
    }
  });
  return result;
}

}  // namespace radiosity
