#include "mesh/clusters/nearest_tree.h"

#include <numeric>

namespace radiosity {

namespace {

/// The rounding of distances: of two sums of six squares.
constexpr double kSlack = 1 - 1e-12;

}  // namespace

NearestTree::NearestTree(std::vector<Point> points)
    : points_(std::move(points)), order_(points_.size()) {
  std::iota(order_.begin(), order_.end(), Index(0));
  build(0, Index(points_.size()));
}

Index NearestTree::build(Index begin, Index end) {
  constexpr Index kLeaf = 8;
  const auto number = Index(nodes_.size());
  Node node;
  node.begin = begin;
  node.end = end;
  node.low.fill(std::numeric_limits<double>::infinity());
  node.high.fill(-std::numeric_limits<double>::infinity());
  for (Index at = begin; at < end; ++at) {
    const Point& p = points_[order_[at]];
    for (std::size_t d = 0; d < kDimensions; ++d) {
      node.low[d] = std::min(node.low[d], p[d]);
      node.high[d] = std::max(node.high[d], p[d]);
    }
  }
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return number;
  std::size_t axis = 0;
  for (std::size_t d = 1; d < kDimensions; ++d) {
    if (node.high[d] - node.low[d] > node.high[axis] - node.low[axis]) axis = d;
  }
  const Index middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](Index a, Index b) { return points_[a][axis] < points_[b][axis]; });
  build(begin, middle);
  const Index second = build(middle, end);
  nodes_[number].second = second;
  return number;
}

double NearestTree::away2Of(const Node& node, const Point& here) {
  double sum = 0;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    const double away = std::max({node.low[d] - here[d], here[d] - node.high[d], 0.0});
    sum += away * away;
  }
  return sum * kSlack;
}

}  // namespace radiosity
