#include "base/geometry/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace radiosity {

BoxTree::BoxTree(std::vector<Box3> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), Index(0));
  if (boxes_.empty()) return;
  nodes_.reserve(2 * boxes_.size());
  nodes_.emplace_back();
  build(0, 0, Index(boxes_.size()));
}

void BoxTree::build(Index node, Index first, Index count) {
  constexpr Index kLeaf = 4;
  Box3 bound = boxes_[order_[first]];
  for (Index k = first; k < first + count; ++k) {
    bound.add(boxes_[order_[k]]);
  }
  nodes_[node].bound = bound;
  nodes_[node].first = first;
  nodes_[node].count = count;
  if (count <= kLeaf) return;
  const Vec3 extent = bound.high - bound.low;
  const int axis =
      extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  const Index half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half,
                   order_.begin() + first + count, [&](Index a, Index b) {
                     const double ca = boxes_[a].low[axis] + boxes_[a].high[axis];
                     const double cb = boxes_[b].low[axis] + boxes_[b].high[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  nodes_[node].first = Index(nodes_.size());
  nodes_[node].count = 0;
  nodes_.emplace_back();
  nodes_.emplace_back();
  const Index child = nodes_[node].first;
  build(child, first, half);
  build(child + 1, first + half, count - half);
}

}  // namespace radiosity
