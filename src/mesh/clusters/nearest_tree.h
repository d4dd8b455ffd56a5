// The nearest points in space and direction at once.
#pragma once

#include <array>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A tree over points of six dimensions (Bentley, "Multidimensional Binary Search Trees Used for
/// Associative Searching", Comm. ACM 18, 1975): each node is halved along its longest side.
class NearestTree {
 public:
  static constexpr std::size_t kDimensions = 6;
  using Point = std::array<double, kDimensions>;

  explicit NearestTree(const std::vector<Point>& points);

  /// The `count` nearest of the other points to point k, or all if they are fewer: the smallest
  /// pairs of squared distance and number, ascending.
  std::vector<Index> nearestTo(Index k, std::size_t count) const;

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

  Index build(const std::vector<Point>& points, Index begin, Index end);
  /// The square of the distance of `here` from the box of a node: in each term no more than that of
  /// any of its points, so that the sum is no more, either, for all its rounding.
  static double away2Of(const Node& node, const Point& here);

  static double distance2(const Point& a, const Point& b);

  std::vector<Index> order_;   ///< numbers of points, node by node
  std::vector<Point> points_;  ///< in that order
  std::vector<Index> at_;      ///< by number: place in that order
  std::vector<Node> nodes_;
};

}  // namespace radiosity
