// Finds closed spaces that no light enters.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/arrangement/arrangement.h"
#include "mesh/bodies/winding.h"
#include "mesh/faces/input_faces.h"

namespace radiosity {

/// Dark hollows: spaces closed on all sides, for more than half of their area by faces seen from
/// behind, without a light in them. A building without a floor on a street, or a cupboard without a
/// bottom, makes one with the ground in it. Patches there would be dark and see nothing but black
/// backs.
class Hollows {
 public:
  Hollows(const Scene& scene, const InputFaces& input, const std::vector<Plane>& planes,
          const EdgeTable& edges, const Arrangement& arrangement, const std::vector<Sheet>& sheets);

  /// Whether a side of a cell looks into one.
  bool isDark(Index cell, Side side) const {
    return dark_[2 * std::size_t(cell) + std::size_t(side)] != 0;
  }

 private:
  std::vector<std::uint8_t> dark_;  ///< by 2 cell + side
};

}  // namespace radiosity
