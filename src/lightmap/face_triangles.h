// The triangles of each side of a scene's faces, with their neighbours.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// One side of a triangle of a face.
struct FaceTriangle {
  Index face = 0;
  Index surface = 0;
  std::array<Index, 3> corner{};  ///< of the face, counter-clockwise seen from this side
  std::array<Vec3, 3> position{};
  Vec3 normal{0.0};  ///< unit, of this side
  /// The triangle of the same surface across edge k (from corner k to the next), if no third has
  /// this edge; kNone: a border.
  std::array<Index, 3> neighbour{kNone, kNone, kNone};
};

/// The fronts of all faces with area, by face.
std::vector<FaceTriangle> frontTriangles(const Scene& scene);

/// The same triangles seen from behind.
std::vector<FaceTriangle> turnedOver(std::span<const FaceTriangle> fronts);

/// Fills FaceTriangle::neighbour. Corners closer than `weld` metres are one.
void findNeighbours(std::vector<FaceTriangle>& triangles, double weld);

}  // namespace radiosity
