// Finds the closed components that are solids or rooms, and the sides that see nothing.
#pragma once

#include <vector>

#include "mesh/bodies/winding.h"

namespace radiosity {

enum class Body {
  none,   ///< open, a one-sided room turned inward, or undecided: no side is hidden by it
  solid,  ///< sides inside it are hidden
  room,   ///< sides outside it are hidden
};

/// The bodies of a scene. A one-sided component is a solid if it is closed and turned outward. The
/// file's orientation of two-sided ones has no meaning, so the other components decide. It is a
/// solid if no other component is inside and one is outside. It is a room if all others are inside,
/// or if there are no others and it is convex. If a component sticks out of it, it is neither. A
/// solid is hollow if closed one-sided components turned inward lie within it: an oven's chamber,
/// or the inner sheet of walls that are modelled as two sheets back to back. If such walls divide a
/// body into chambers, all its inner sheets are one component, which lies within no single chamber:
/// it makes every solid that it touches hollow if its fronts look into solids everywhere.
class Bodies {
 public:
  Bodies(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
         const Components& components, const Winding& winding);

  /// Ascending.
  const std::vector<Index>& rooms() const { return rooms_; }
  /// Whether the space next to a side of a cell is inside a solid, and in none of its cavities.
  bool isWithin(Index solid, Index cell, Side side) const;
  /// Whether an open one-sided component has no cell outside a solid, such as a second layer of
  /// some of its faces, turned inward. A solid does not stand on its lining.
  bool isLining(Index component, Index solid) const;
  /// Whether isWithin() is true for any solid.
  bool isWithinAny(Index cell, Side side) const;

 private:
  std::vector<bool> lookIntoSolids(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
                                   const Components& components) const;

  const Winding& winding_;
  std::vector<Body> body_;  ///< by component
  std::vector<Index> rooms_;
  std::vector<std::vector<Index>> cavities_;  ///< of solids, by component
  std::vector<std::vector<Index>> linings_;   ///< of solids, by component, ascending
};

}  // namespace radiosity
