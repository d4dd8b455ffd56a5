// Finds faces of a scene that lie on each other.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "mesh/patches/face_crossings.h"
#include "radiosity/scene.h"

namespace radiosity {

/// By face: the first face before it with the same corners and, unless both are two-sided, the same
/// facing; kNone if there is none.
std::vector<Index> findRepeats(const Scene& scene);

/// So many overlaps are found at most: a thousand faces on each other have half a million.
inline constexpr std::size_t kMostOverlaps = 1000;

/// Pairs of faces (lower first, sorted) with sides that look the same way in one plane, within
/// `coincidence`, and share an area that is wider than that. Throws Cancelled.
std::vector<std::pair<Index, Index>> findOverlaps(const Scene& scene,
                                                  std::span<const FacePiece> pieces,
                                                  double coincidence, Progress& progress);

}  // namespace radiosity
