// The nearest points in space and direction at once.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A tree over points of six dimensions (Bentley, "Multidimensional Binary Search Trees Used for
/// Associative Searching", Comm. ACM 18, 1975): each node is halved along its longest side.
class NearestTree {
 public:
  static constexpr std::size_t kDimensions = 6;
  using Point = std::array<double, kDimensions>;

  explicit NearestTree(std::vector<Point> points);

  /// The `count` nearest of the other points to point k, or all if they are fewer: the smallest
  /// pairs of distance2(k, other) and `other`, ascending. `distance2` is the square of the distance
  /// to within rounding.
  template <class Distance2>
  std::vector<Index> nearestTo(Index k, std::size_t count, const Distance2& distance2) const {
    std::vector<std::pair<double, Index>> found;  // ascending
    double most = std::numeric_limits<double>::infinity();
    const Point& here = points_[k];
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
          const Index other = order_[at];
          if (other == k) continue;
          const std::pair next{distance2(k, other), other};
          if (found.size() == count && next > found.back()) continue;
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

 private:
  struct Node {
    Point low;
    Point high;
    Index begin = 0;  ///< of its points in order_
    Index end = 0;
    Index second = 0;  ///< its second child; the first follows it; 0: a leaf
  };
  /// Each level halves the points, and one node a level waits.
  static constexpr std::size_t kMostWaiting = 34;

  Index build(Index begin, Index end);
  /// A lower bound for the square of the distance of `here` from the points of a node.
  static double away2Of(const Node& node, const Point& here);

  std::vector<Point> points_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity
