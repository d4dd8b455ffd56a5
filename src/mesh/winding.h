// What lies on the two sides of every cell.
#pragma once

#include <vector>

#include "mesh/arrangement.h"
#include "mesh/components.h"

namespace radiosity {

/// The two sides of a cell.
enum Side : int { kAbove = 0, kBelow = 1 };

/// For each side of each cell, the closed components it looks into and how many times.
class Winding {
 public:
  Winding(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
          const Components& components, double coincidence);

  /// Winding number of closed component `c` in the space next to a side of a cell: 1 inside,
  /// 0 outside (other numbers where it overlaps itself).
  int of(Index component, Index cell, Side side) const;

  struct Entry {
    Index component;
    int number;  ///< not 0
  };
  const std::vector<Entry>& at(Index cell, Side side) const {
    return spaces_[space_[2 * std::size_t(cell) + side]];
  }

 private:
  std::vector<Index> space_;                ///< by 2 cell + side
  std::vector<std::vector<Entry>> spaces_;  ///< ascending by component
};

/// The winding number of closed outward triangles as seen from a point off their planes: the sum
/// of signed solid angles over 4 pi. The triangle's solid angle: A. van Oosterom, J. Strackee,
/// "The solid angle of a plane triangle", IEEE Trans. Biomed. Eng. 30 (1983), eq. 8.
double solidAngle(const Vec3& from, const std::array<Vec3, 3>& triangle);

}  // namespace radiosity
