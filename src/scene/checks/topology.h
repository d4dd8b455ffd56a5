// The topology of faces: edges, connected parts, orientation.
#pragma once

#include <vector>

#include "scene/checks/welded_faces.h"

namespace radiosity {

/// Faces connected by edges that exactly two faces share.
struct ConnectedPart {
  std::vector<Index> faces;
  Vec3 lower{0.0};  ///< box, relative to WeldedFaces::centre
  Vec3 upper{0.0};
  bool closed = false;  ///< no edge of the part is open
  bool orientable = true;
  double volume = 0;  ///< m^3, positive where the fronts face outwards; 0 unless closed
};

struct Topology {
  std::size_t open_edges = 0;         ///< used by one face alone
  std::size_t nonmanifold_edges = 0;  ///< used by more than two faces
  bool closed = false;                ///< every part is closed and has a volume
  std::vector<ConnectedPart> parts;
  std::vector<Index> part_of;  ///< F, kNone for a face left out
  /// F, 1: wound against the majority (by area) of its part.
  std::vector<std::uint8_t> flipped;
};

/// `two_sided`: F, faces whose winding does not matter. `skip`: F, faces to leave out (doubles of
/// others). Degenerate faces with fewer than three corners are always left out.
Topology analyseTopology(const WeldedFaces& faces, const std::vector<std::uint8_t>& two_sided,
                         const std::vector<std::uint8_t>& skip);

}  // namespace radiosity
