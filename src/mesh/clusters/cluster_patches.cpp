#include "mesh/clusters/cluster_patches.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "mesh/clusters/agglomerate.h"
#include "mesh/clusters/nearest_tree.h"
#include "mesh/patches/canonical_order.h"

namespace radiosity {

namespace {

/// The weight of a change of the normal by 1, in sides of a square with the mean area of a cluster.
/// With half or twice this weight, surfaces of six scenes have about the same power.
constexpr double kBend = 1.0;
/// The number of nearest neighbours that each cluster is paired with, beside those at its edges.
constexpr std::size_t kNearest = 3;
/// Each patch at an edge is paired with this many that follow there: all, unless very many meet.
constexpr std::size_t kAtAnEdge = 4;

std::vector<Index> frontsInOrder(const PatchMesh& mesh) {
  std::vector<Index> fronts = canonicalOrder(mesh);
  std::erase_if(fronts, [&](Index i) { return mesh.side[i] != 0 || !(mesh.area[i] > 0); });
  return fronts;
}

std::vector<Agglomerate> agglomeratesOf(const PatchMesh& mesh, std::span<const Index> fronts) {
  const Vec3 centre = mesh.centroid[fronts[0]];
  std::vector<Agglomerate> pieces;
  pieces.reserve(fronts.size());
  for (const Index i : fronts) {
    const double area = mesh.area[i];
    pieces.push_back({area, area * (mesh.centroid[i] - centre), area * mesh.normal[i]});
  }
  return pieces;
}

/// The other end of an edge from a vertex to one with a higher number, with a front at it.
struct EdgeEnd {
  Index other;  ///< vertex
  Index front;
  bool operator<(const EdgeEnd& b) const {
    return std::tie(other, front) < std::tie(b.other, b.front);
  }
};

/// Calls visit(fronts) with the fronts at each edge, ascending. A front is given by its place in
/// `fronts`.
template <class Visit>
void forEdges(const PatchMesh& mesh, std::span<const Index> fronts, const Visit& visit) {
  const auto forSides = [&](const auto& side) {
    for (Index k = 0; k < fronts.size(); ++k) {
      const auto outline = mesh.outline(fronts[k]);
      for (std::size_t c = 0; c < outline.size(); ++c) {
        const auto [low, high] = std::minmax(outline[c], outline[(c + 1) % outline.size()]);
        side(low, high, k);
      }
    }
  };
  std::vector<std::size_t> begin(mesh.vertices.size() + 2, 0);
  forSides([&](Index low, Index, Index) { ++begin[low + 2]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<EdgeEnd> ends(begin.back());
  forSides([&](Index low, Index high, Index k) { ends[begin[low + 1]++] = {high, k}; });
  std::vector<Index> at;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const std::span<EdgeEnd> here(&ends[begin[v]], begin[v + 1] - begin[v]);
    std::sort(here.begin(), here.end());
    for (std::size_t k = 0; k < here.size(); ++k) {
      at.push_back(here[k].front);
      if (k + 1 < here.size() && here[k + 1].other == here[k].other) continue;
      visit(std::span<const Index>(at));
      at.clear();
    }
  }
}

/// The clusters of fronts, by place in the order of fronts.
class FrontClusters {
 public:
  FrontClusters(const PatchMesh& mesh, std::span<const Index> fronts, std::size_t wanted)
      : mesh_(mesh), fronts_(fronts), wanted_(wanted), parts_({}, 0, 1) {
    std::vector<Agglomerate> pieces = agglomeratesOf(mesh, fronts);
    for (const Agglomerate& piece : pieces) area_ += piece.area;
    parts_ = Agglomeration(std::move(pieces), kBend * sideOf(wanted), sideOf(wanted));
  }

  /// Finds neighbours anew whenever half of the clusters are gone. Every cluster that is not alone
  /// in its surface has some, so this ends with the wanted number, or with one cluster a surface.
  void run(Progress& progress) {
    offerAtEdges();
    for (std::size_t before = 0; parts_.size() > wanted_ && parts_.size() != before;) {
      before = parts_.size();
      // The metric depends on the present number of clusters, so that searches stay short.
      bend_ = kBend * sideOf(before);
      offerNearest(progress);
      parts_.run(std::max(wanted_, before / 2), progress);
    }
  }

  /// The place of the first front in the cluster of the front at place k.
  Index of(Index k) { return parts_.of(k); }

 private:
  /// The side of a square with a `count`-th of all area.
  double sideOf(std::size_t count) const { return std::sqrt(area_ / double(count)); }

  void offerAtEdges() {
    forEdges(mesh_, fronts_, [&](std::span<const Index> at) {
      for (std::size_t a = 0; a < at.size(); ++a) {
        for (std::size_t b = a + 1; b < std::min(at.size(), a + 1 + kAtAnEdge); ++b) {
          if (mesh_.surface[fronts_[at[a]]] == mesh_.surface[fronts_[at[b]]]) {
            parts_.offer(at[a], at[b]);
          }
        }
      }
    });
  }

  void offerNearest(Progress& progress) {
    std::vector<Index> clusters;
    for (Index k = 0; k < fronts_.size(); ++k) {
      const bool other = k > 0 && mesh_.surface[fronts_[k]] != mesh_.surface[fronts_[k - 1]];
      if (other) offerNearestOf(std::exchange(clusters, {}), progress);
      if (parts_.of(k) == k) clusters.push_back(k);
    }
    offerNearestOf(clusters, progress);
  }

  /// Offers the nearest pairs of all clusters of one surface.
  void offerNearestOf(const std::vector<Index>& clusters, Progress& progress) {
    if (clusters.size() < 2) return;
    progress.check();
    std::vector<NearestTree::Point> points;
    points.reserve(clusters.size());
    for (const Index k : clusters) points.push_back(placeOf(parts_.at(k)));
    const NearestTree tree(points);
    std::vector<std::vector<Index>> nearest(clusters.size());
    parallelFor(clusters.size(), 64, [&](std::size_t c) {
      if (!progress.cancelled()) nearest[c] = tree.nearestTo(Index(c), kNearest);
    });
    progress.check();
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      for (const Index other : nearest[c]) parts_.offer(clusters[c], clusters[other]);
    }
  }

  /// The place of a cluster in the space of centroids and `bend_` times normals.
  NearestTree::Point placeOf(const Agglomerate& cluster) const {
    const Vec3 centroid = cluster.moment / cluster.area;
    const Vec3 turn = bend_ * (cluster.normals / cluster.area);
    return {centroid.x, centroid.y, centroid.z, turn.x, turn.y, turn.z};
  }

  const PatchMesh& mesh_;
  std::span<const Index> fronts_;
  std::size_t wanted_;
  double area_ = 0;
  double bend_ = 0;  ///< among neighbours
  Agglomeration parts_;
};

/// Numbers keys in the order of their first occurrence; returns the number of different keys.
std::size_t renumber(std::vector<Index>& keys, std::size_t limit) {
  std::vector<Index> number(limit, kNone);
  Index count = 0;
  for (Index& key : keys) {
    if (number[key] == kNone) number[key] = count++;
    key = number[key];
  }
  return count;
}

/// Makes `count` clusters from the cluster of each patch. No cluster is empty.
PatchClusters clustersOf(std::vector<Index> of_patch, std::size_t count) {
  PatchClusters clusters;
  clusters.of_patch = std::move(of_patch);
  clusters.begin.assign(count + 1, 0);
  for (const Index c : clusters.of_patch) ++clusters.begin[c + 1];
  std::partial_sum(clusters.begin.begin(), clusters.begin.end(), clusters.begin.begin());
  clusters.patches.resize(clusters.of_patch.size());
  std::vector<std::size_t> next(clusters.begin.begin(), clusters.begin.end() - 1);
  for (Index i = 0; i < clusters.of_patch.size(); ++i) {
    clusters.patches[next[clusters.of_patch[i]]++] = i;
  }
  return clusters;
}

}  // namespace

PatchClusters clusterPatches(const PatchMesh& mesh, std::size_t wanted, Progress& progress) {
  const std::vector<Index> fronts = frontsInOrder(mesh);
  progress.begin("joining patches", fronts.size() - std::min(wanted, fronts.size()));
  FrontClusters parts(mesh, fronts, wanted);
  parts.run(progress);
  progress.end();
  // The key of a front is the place of the first in its cluster; those of backs follow, then those
  // of degenerate patches, which are on their own.
  std::vector<Index> key(mesh.size());
  std::iota(key.begin(), key.end(), Index(2 * fronts.size()));
  for (Index k = 0; k < fronts.size(); ++k) {
    const Index front = fronts[k];
    key[front] = parts.of(k);
    if (mesh.twin[front] != kNone) key[mesh.twin[front]] = Index(fronts.size()) + key[front];
  }
  const std::size_t count = renumber(key, 2 * fronts.size() + mesh.size());
  return clustersOf(std::move(key), count);
}

}  // namespace radiosity
