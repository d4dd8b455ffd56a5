// Faces that face each other across a gap that counts as nothing.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// The least distance between the planes of two faces that face each other: every corner of each is
/// in front of the other, by more than rounding; else 0.
double gapBetween(const Scene& scene, Index first, Index second);

/// Collects gaps that are lost, by pairs of surfaces.
class LostGaps {
 public:
  void add(const Scene& scene, Index first, Index second, double gap);
  /// A warning a pair, with the weld that would keep the gap. `coincidence`: metres.
  std::vector<Note> notes(const Scene& scene, double coincidence) const;

 private:
  std::map<std::pair<Index, Index>, double> least_;  ///< by surfaces, ascending
};

}  // namespace radiosity
