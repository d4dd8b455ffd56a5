// Finds faces of a scene that pass through each other.
#pragma once

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// A triangle of a face: indices of scene vertices. Bit k of `rim` is set if the edge from corner k
/// to k + 1 belongs to the face's outline.
struct FacePiece {
  Index face = kNone;
  std::array<Index, 3> corners{};
  unsigned rim = 0;
};

/// Pairs of faces (lower first, sorted) that cross: each has corners more than `coincidence` in
/// front of and behind the other's plane, and they share a segment longer than `coincidence` that
/// runs inside both outlines. Faces that touch, share an edge or overlap in a plane do not cross.
/// Throws Cancelled.
std::vector<std::pair<Index, Index>> findCrossings(const Scene& scene,
                                                   std::span<const FacePiece> pieces,
                                                   double coincidence, Progress& progress);

}  // namespace radiosity
