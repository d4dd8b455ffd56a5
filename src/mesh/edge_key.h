// Keys of edges in hash tables.
#pragma once

#include <algorithm>
#include <cstdint>

#include "radiosity/base.h"

namespace radiosity {

/// A key for the edge from `a` to `b`; the edge from b to a has another.
inline std::uint64_t directedKey(Index a, Index b) { return (std::uint64_t(a) << 32) | b; }

/// A key for the edge between two vertices, in either order.
inline std::uint64_t edgeKey(Index a, Index b) {
  return directedKey(std::min(a, b), std::max(a, b));
}

}  // namespace radiosity
