// Winding numbers of closed surfaces of many triangles.
#pragma once

#include <array>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// A triangle's solid angle from a point off its plane, signed: A. van Oosterom, J. Strackee, "The
/// solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30 (1983), eq. 8.
double solidAngle(const Vec3& from, const std::array<Vec3, 3>& triangle);

/// Triangles in a tree. Groups of them far from a point count as the dipole they make: G. Barill,
/// N. Dickson, R. Schmidt, D. Levin, A. Jacobson, "Fast Winding Numbers for Soups and Clouds", ACM
/// Trans. Graph. 37 (2018), section 3.
class WindingTree {
 public:
  /// `plane`: by triangle, the number of its plane. References are kept.
  WindingTree(const std::vector<std::array<Vec3, 3>>& triangles, const std::vector<Index>& plane);

  /// The sum of the solid angles of all triangles over 4 pi, seen from a point in plane `own`:
  /// triangles there count as nothing. Of a closed surface this is the whole number of times it
  /// goes around the point, less the half of `own`; off by some hundredths.
  double around(const Vec3& from, Index own) const;

 private:
  struct Node {
    Index begin = 0;  ///< into order_
    Index end = 0;
    Index left = kNone;  ///< the right child follows the left one's subtree
    Index right = kNone;
    Vec3 centre{0.0};  ///< of area
    Vec3 area{0.0};    ///< sum of vector areas
    double radius = 0;
  };
  Index build(Index begin, Index end);
  double sum(Index node, const Vec3& from, Index own) const;

  const std::vector<std::array<Vec3, 3>>& triangles_;
  const std::vector<Index>& plane_;
  std::vector<Index> order_;
  std::vector<Node> nodes_;
};

}  // namespace radiosity
