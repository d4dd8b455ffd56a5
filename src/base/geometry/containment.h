// Where something is with respect to something closed.
#pragma once

namespace radiosity {

/// With respect to a closed surface, or to the outline of a polygon in its plane.
enum class Containment { inside, on, outside };

}  // namespace radiosity
