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

/// One-sided components: solid if closed and turned outward. The file's orientation of two-sided
/// ones means nothing, so what else there is decides: solid if no other component is inside and
/// something is outside; room if everything else is inside, or if there is nothing else and it
/// is convex. A component that sticks out of a larger one leaves it undecided which of the two
/// the larger one is, and then it is neither.
std::vector<Body> findBodies(const Arrangement& arrangement, const Components& components,
                             const Winding& winding, double coincidence);

}  // namespace radiosity
