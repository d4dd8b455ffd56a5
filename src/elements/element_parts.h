// The four parts of an element by its points: its corners, then the middles of its edges (n + k:
// from corner k to the next) and, in a quadrilateral, its centre.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace radiosity {

/// Corners of a part, as numbers of points; in a triangle the fourth repeats the third.
using PartCorners = std::array<std::uint8_t, 4>;

inline constexpr std::array<PartCorners, 4> kQuarters = {
    {{0, 4, 8, 7}, {4, 1, 5, 8}, {8, 5, 2, 6}, {7, 8, 6, 3}}};
inline constexpr std::array<PartCorners, 4> kTriangleParts = {
    {{0, 3, 5, 5}, {3, 1, 4, 4}, {5, 4, 2, 2}, {4, 5, 3, 3}}};

/// The parts of an element of 3 or 4 corners.
constexpr const std::array<PartCorners, 4>& partsOf(std::size_t corners) {
  return corners == 4 ? kQuarters : kTriangleParts;
}

/// The number of points of an element: its corners, and if it is tested those in between.
constexpr std::size_t pointCount(std::size_t corners, bool tested) {
  if (!tested) return corners;
  return corners == 4 ? 9 : 6;
}

}  // namespace radiosity
