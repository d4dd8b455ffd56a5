// Which closed components are solid bodies, which are rooms, and which sides see nothing.
#pragma once

#include <vector>

#include "mesh/winding.h"

namespace radiosity {

enum class Body {
  none,   ///< open, or a room turned inward, or not to be told: nothing follows from it
  solid,  ///< nothing is to be seen inside
  room,   ///< nothing is to be seen outside
};

/// The bodies of a scene. One-sided components: solid if closed and turned outward. The file's
/// orientation of two-sided ones means nothing, so what else there is decides: solid if no other
/// component is inside and something is outside; room if everything else is inside, or if there is
/// nothing else and it is convex. A component that sticks out of a larger one leaves it undecided
/// which of the two the larger one is, and then it is neither.
/// A solid is hollow where closed one-sided components turned inward lie within it: an oven's
/// chamber, the inner sheet of walls that are modelled as two sheets back to back. Where such walls
/// part a body into chambers, all of its inner sheets are one component, within no chamber alone:
/// it makes every solid hollow that it touches if its fronts look into solids everywhere.
class Bodies {
 public:
  Bodies(const Arrangement& arrangement, const std::vector<Sheet>& sheets,
         const Components& components, const Winding& winding, double coincidence);

  /// Ascending.
  const std::vector<Index>& rooms() const { return rooms_; }
  /// Whether the space next to a side of a cell is inside a solid, and in none of its cavities.
  bool isWithin(Index solid, Index cell, Side side) const;
  /// Whether an open one-sided component has no cell outside a solid: a second layer of some of
  /// its faces, turned inward, is one. A solid does not stand on its lining.
  bool isLining(Index component, Index solid) const;
  /// The same as isWithin(), of any solid.
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
