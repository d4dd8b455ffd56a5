#include "base/geometry/box_tree.h"

#include <algorithm>
#include <numeric>

#include "base/parallel.h"

namespace radiosity {

namespace {

constexpr Index kLeafBoxes = 4;
constexpr Index kWorthATask = 8192;

/// The number of nodes below a node of `count` boxes.
Index nodesBelow(Index count) {
  return count <= kLeafBoxes ? 0 : 2 + nodesBelow(count / 2) + nodesBelow(count - count / 2);
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box3>& boxes) : order_(boxes.size()) {
  std::iota(order_.begin(), order_.end(), Index(0));
  if (boxes.empty()) return;
  nodes_.resize(1 + nodesBelow(Index(boxes.size())));
  build(0, 0, Index(boxes.size()), 1, boxes);
  boxes_.reserve(boxes.size());
  for (const Index k : order_) boxes_.push_back(boxes[k]);
}

/// `below`: the index of the first node below this one.
void BoxTree::build(Index node, Index first, Index count, Index below,
                    const std::vector<Box3>& boxes) {
  Box3 bound = boxes[order_[first]];
  for (Index k = first; k < first + count; ++k) bound.add(boxes[order_[k]]);
  nodes_[node] = {bound, first, count, count};
  if (count <= kLeafBoxes) return;
  const int axis = bound.longestAxis();
  const Index half = count / 2;
  std::nth_element(order_.begin() + first, order_.begin() + first + half,
                   order_.begin() + first + count, [&](Index a, Index b) {
                     const double ca = boxes[a].low[axis] + boxes[a].high[axis];
                     const double cb = boxes[b].low[axis] + boxes[b].high[axis];
                     return ca != cb ? ca < cb : a < b;
                   });
  nodes_[node].first = below;
  nodes_[node].count = 0;
  const Index right = below + 2 + nodesBelow(half);
  const auto buildLeft = [&] { build(below, first, half, below + 2, boxes); };
  const auto buildRight = [&] { build(below + 1, first + half, count - half, right, boxes); };
  if (count < kWorthATask) {
    buildLeft();
    buildRight();
  } else {
    parallelBoth(buildLeft, buildRight);
  }
}

}  // namespace radiosity
