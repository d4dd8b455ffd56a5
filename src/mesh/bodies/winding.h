// Winding numbers on the two sides of every cell.
#pragma once

#include <vector>

#include "mesh/arrangement/arrangement.h"
#include "mesh/bodies/components.h"
#include "radiosity/base.h"

namespace radiosity {

/// The two sides of a cell.
enum Side : int { kAbove = 0, kBelow = 1 };

/// For each side of each cell, the closed components into which it looks, with the number of times.
class Winding {
 public:
  Winding(const Arrangement& arrangement, const std::vector<Plane>& planes,
          const std::vector<Sheet>& sheets, const Components& components, Progress& progress);

  /// Winding number of closed component `component` in the space next to a side of a cell: 1
  /// inside, 0 outside (other numbers where the component overlaps itself).
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

}  // namespace radiosity
