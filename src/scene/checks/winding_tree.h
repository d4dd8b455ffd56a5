// Winding numbers of closed surfaces about points.
#pragma once

#include <array>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A tree over the triangles of a closed surface. Triangles far from a point count together, by one
/// dipole (G. Barill et al., "Fast winding numbers for soups and clouds", 2018, eq. 14 to its first
/// term). The time of a query is about the logarithm of the number of triangles.
class WindingTree {
 public:
  struct Triangle {
    std::array<Vec3, 3> corners;  ///< counter-clockwise from outside
    Index plane = kNone;          ///< a number that coplanar triangles share
  };
  explicit WindingTree(std::vector<Triangle> triangles);

  /// 1 or -1 inside, 0 outside, about a half on the surface; the error is at most 0.05. Triangles
  /// of plane `own`, if given, count as 0: the point lies in that plane.
  double around(const Vec3& point, Index own = kNone) const;

 private:
  struct Node {
    Vec3 middle{0.0};       ///< of the area
    Vec3 area{0.0};         ///< sum of normal times area
    double radius = 0;      ///< around middle, of all corners
    std::size_t begin = 0;  ///< of its triangles
    std::size_t end = 0;
    std::size_t second = 0;  ///< its second child; the first follows it; 0: a leaf
  };
  std::size_t build(std::size_t begin, std::size_t end);
  void measure(Node& node) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity
