#include "formfactor/cut/row_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace radiosity {
namespace {

struct HitPatch {
  Index place;
  std::array<std::uint32_t, kReplicates> hits;
};

}  // namespace

PatchTree treeOfPatches(const PatchMesh& mesh, const RayScene& scene,
                        std::span<const Index> known) {
  std::vector<std::uint8_t> left_out(scene.size(), 0);
  for (const Index patch : known) left_out[patch] = 1;
  std::vector<PatchTree::Patch> patches;
  for (std::size_t k = 0; k < scene.size(); ++k) {
    const double area = scene.area()[k];
    const Index patch = scene.order()[k];
    if (!(area > 0) || left_out[patch] != 0) continue;
    const glm::vec3 at = scene.caster().place(mesh.centroid[patch]);
    const glm::vec3 facing(mesh.normal[patch]);
    patches.push_back(
        {.at = {at.x, at.y, at.z, facing.x, facing.y, facing.z}, .area = area, .patch = patch});
  }
  return PatchTree(std::move(patches));
}

RowCutter::RowCutter(const RayScene& scene, const PatchTree& tree, double opening)
    : scene_(scene), tree_(tree), opening_(opening), place_(scene.size(), kNone) {
  for (std::size_t k = 0; k < tree.patches().size(); ++k) {
    place_[tree.patches()[k].patch] = Index(k);
  }
}

/// Walks down from the root as far as nodes that were hit are too large.
class RowCutter::Descent {
 public:
  Descent(const RowCutter& cutter, std::size_t place, CutRows& rows)
      : tree_(cutter.tree_),
        opening_(cutter.opening_),
        from_(cutter.tree_.patches()[place].at),
        rows_(rows) {}

  void operator()(std::size_t node, std::span<const HitPatch> hits) const {
    if (hits.empty()) return;
    const PatchTree::Node& of = tree_.nodes()[node];
    if (of.isLeaf() || isSmall(tree_.fit(node))) return add(node, hits);
    const std::size_t second = tree_.second(node);
    const auto middle =
        std::ranges::lower_bound(hits, tree_.nodes()[second].begin, {}, &HitPatch::place);
    const auto first = std::size_t(middle - hits.begin());
    (*this)(tree_.first(node), hits.first(first));
    (*this)(second, hits.subspan(first));
  }

 private:
  bool isSmall(const PatchTree::Fit& fit) const {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double along = fit.middle[k] - double(from_[k]);
      square += along * along;
    }
    return fit.radius * fit.radius <= opening_ * opening_ * square;
  }

  void add(std::size_t node, std::span<const HitPatch> hits) const {
    CutRows::Hits sums{};
    std::array<double, kPatchFeatures> mean{};
    double all = 0;
    for (const HitPatch& hit : hits) {
      for (std::size_t r = 0; r < kReplicates; ++r) {
        sums[r] = std::uint16_t(sums[r] + hit.hits[r]);
      }
      const double both = double(hit.hits[0]) + double(hit.hits[1]);
      all += both;
      for (std::size_t k = 0; k < kPatchFeatures; ++k) {
        mean[k] += both * double(tree_.patches()[hit.place].at[k]);
      }
    }
    CutRows::Place place{};
    if (!tree_.nodes()[node].isLeaf()) {
      for (double& of : mean) of /= all;
      const auto f = tree_.fit(node).relative(mean);
      for (std::size_t k = 0; k < kPatchFeatures; ++k) {
        place[k] = std::int8_t(std::lround(std::clamp(f[k] / CutRows::stepOf(k), -127.0, 127.0)));
      }
    }
    rows_.nodes.push_back(Index(node));
    rows_.hits.push_back(sums);
    rows_.places.push_back(place);
  }

  const PatchTree& tree_;
  double opening_;
  PatchTree::Features from_;
  CutRows& rows_;
};

CutCounts RowCutter::cut(std::size_t place, const RayRow& row, CutRows& rows) const {
  CutCounts counts;
  counts.rays = row.counted();
  counts.sky = row.countedSky();
  std::vector<HitPatch> hits;
  hits.reserve(row.columns.size());
  const std::size_t n = scene_.size();
  for (std::size_t e = 0; e < row.columns.size(); ++e) {
    const Index column = row.columns[e];
    const double both = double(row.hits[e][0]) + double(row.hits[e][1]);
    if (column >= n) {
      counts.backs.push_back({Index(column - n), both});
    } else if (const Index hit = place_[scene_.order()[column]]; hit != kNone) {
      hits.push_back({hit, row.hits[e]});
    } else {
      counts.known += both;
    }
  }
  std::ranges::sort(hits, {}, &HitPatch::place);
  Descent(*this, place, rows)(0, hits);
  rows.ends.push_back(std::uint32_t(rows.nodes.size()));
  return counts;
}

}  // namespace radiosity
