// How often a closed surface winds around a point.
#pragma once

#include <array>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A tree over the triangles of a closed surface: those far from a point count together, by the
/// dipole that stands for them (G. Barill et al., "Fast winding numbers for soups and clouds",
/// 2018, eq. 14 to its first term). A query takes time about log of the number of triangles.
class WindingTree {
 public:
  struct Triangle {
    std::array<Vec3, 3> corners;  ///< counter-clockwise from outside
    Index plane = kNone;          ///< a number that coplanar triangles share
  };
  explicit WindingTree(std::vector<Triangle> triangles);

  /// 1 or -1 inside, 0 outside, about a half on the surface; off by 0.05 at most. Triangles of
  /// plane `own`, if it is given, count as nothing: the point lies in that plane.
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
