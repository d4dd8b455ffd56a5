// Finds faces that lie on one another.
#pragma once

#include <vector>

#include "scene/checks/welded_faces.h"

namespace radiosity {

/// Two faces with the same corners that face alike; `second` comes later in the file.
struct DoubledFace {
  Index first;
  Index second;
};
std::vector<DoubledFace> findDoubledFaces(const WeldedFaces& faces);

/// Two planar faces, not doubles, with a common area in one plane.
struct Overlap {
  Index first;
  Index second;
  bool alike;   ///< both face the same way
  double area;  ///< m^2
};
struct OverlapSearch {
  std::vector<Overlap> overlaps;  ///< ascending by first, second
  /// False if the search was given up because too many faces are in one place: there may be more.
  bool complete = true;
};
/// `skip`: F, faces to leave out.
OverlapSearch findOverlaps(const WeldedFaces& faces, const std::vector<std::uint8_t>& skip);

/// The deviation of face f from a plane, m: for a quadrilateral the largest distance of a corner
/// from the plane of the other three, else the spread of the corners across the mean plane.
double planeDeviation(const WeldedFaces& faces, std::size_t f);

}  // namespace radiosity
