#include "mesh/clusters/nearest_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace radiosity {

NearestTree::NearestTree(const std::vector<Point>& points)
    : order_(points.size()), at_(points.size()) {
  std::iota(order_.begin(), order_.end(), Index(0));
  build(points, 0, Index(points.size()));
  points_.reserve(points.size());
  for (Index at = 0; at < order_.size(); ++at) {
    points_.push_back(points[order_[at]]);
    at_[order_[at]] = at;
  }
}

Index NearestTree::build(const std::vector<Point>& points, Index begin, Index end) {
  constexpr Index kLeaf = 8;
  const auto number = Index(nodes_.size());
  Node node;
  node.begin = begin;
  node.end = end;
  node.low.fill(std::numeric_limits<double>::infinity());
  node.high.fill(-std::numeric_limits<double>::infinity());
  for (Index at = begin; at < end; ++at) {
    const Point& p = points[order_[at]];
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
                   [&](Index a, Index b) { return points[a][axis] < points[b][axis]; });
  build(points, begin, middle);
  const Index second = build(points, middle, end);
  nodes_[number].second = second;
  return number;
}

double NearestTree::distance2(const Point& a, const Point& b) {
  double sum = 0;
  for (std::size_t d = 0; d < kDimensions; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
  return sum;
}

double NearestTree::away2Of(const Node& node, const Point& here) {
  double sum = 0;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    const double away = std::max({node.low[d] - here[d], here[d] - node.high[d], 0.0});
    sum += away * away;
  }
  return sum;
}

std::vector<Index> NearestTree::nearestTo(Index k, std::size_t count) const {
  std::vector<std::pair<double, Index>> found;  // ascending
  found.reserve(count + 1);
  double most = std::numeric_limits<double>::infinity();
  const Point& here = points_[at_[k]];
  // Children are pushed farther first, so that the nearer one lowers `most` for the other.
  std::array<std::pair<double, Index>, kMostWaiting> waiting;
  std::size_t height = 0;
  waiting[height++] = {0.0, 0};
  while (height > 0) {
    const auto [away2, number] = waiting[--height];
    if (away2 > most) continue;
    const Node& node = nodes_[number];
    if (node.second == 0) {
      for (Index at = node.begin; at < node.end; ++at) {
        const std::pair next{distance2(here, points_[at]), order_[at]};
        if (next.second == k || (found.size() == count && next > found.back())) continue;
        found.insert(std::lower_bound(found.begin(), found.end(), next), next);
        if (found.size() > count) found.pop_back();
        if (found.size() == count) most = found.back().first;
      }
      continue;
    }
    std::pair first{away2Of(nodes_[number + 1], here), number + 1};
    std::pair second{away2Of(nodes_[node.second], here), node.second};
    if (first.first < second.first) std::swap(first, second);
    waiting[height++] = first;
    waiting[height++] = second;
  }
  std::vector<Index> nearest;
  nearest.reserve(found.size());
  for (const auto& [far, other] : found) nearest.push_back(other);
  return nearest;
}

}  // namespace radiosity
