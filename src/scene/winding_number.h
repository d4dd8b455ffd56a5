// How often a closed part of a scene winds around a point.
#pragma once

#include <span>
#include <vector>

#include "scene/topology.h"

namespace radiosity {

/// A tree over the triangles of a part: those far from a point count together, by the dipole that
/// stands for them (G. Barill et al., "Fast winding numbers for soups and clouds", 2018, eq. 14 to
/// its first term). A query takes time about log of the number of faces.
class WindingNumber {
 public:
  WindingNumber(const WeldedFaces& faces, const ConnectedPart& part);

  /// 1 or -1 inside, 0 outside, about a half on the part; off by 0.05 at most. `point` is relative
  /// to the centre of the welded faces.
  double at(const Vec3& point) const;

 private:
  struct Triangle {
    Vec3 a, b, c;
  };
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
