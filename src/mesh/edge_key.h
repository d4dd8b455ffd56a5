// Names of edges in hash tables.
#pragma once

#include <algorithm>
#include <cstdint>

#include "radiosity/base.h"

namespace radiosity {

/// One number for the edge from `a` to `b`; another one for b to a.
inline std::uint64_t directedKey(Index a, Index b) { return (std::uint64_t(a) << 32) | b; }

/// One number for the edge between two vertices, whichever comes first.
inline std::uint64_t edgeKey(Index a, Index b) {
  return directedKey(std::min(a, b), std::max(a, b));
}

}  // namespace radiosity
