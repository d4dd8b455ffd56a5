// The directions that are measured in, and rays in all directions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "radiosity/illuminance.h"

namespace radiosity {

inline constexpr std::size_t kCubeFaces = 6;

/// The normals of a small cube, x_plus first.
std::array<Vec3, kCubeFaces> cubeNormals();

/// Upright surfaces whose mean stands for a cylinder. By directions at equal angles the mean of
/// max(0, cos) around a small lamp is off by the harmonics of it that are multiples of their number
/// n; max(0, cos) has no odd ones but the first, so for an odd n the first of these is 2n: the mean
/// is off by at most 2 / (4 n^2 - 1) of it, 5.2e-4 for 31.
inline constexpr std::size_t kUprights = 31;
std::array<Vec3, kUprights> uprightNormals(Up up);

/// Independent sets of directions, alike over the sphere: scrambled Sobol points, z = 1 - 2u about
/// the axis z. The first 2^k of a set are spread by themselves.
class SphereSets {
 public:
  static constexpr std::size_t kSets = 8;
  static constexpr std::size_t kFewest = 128;  ///< of a set
  explicit SphereSets(std::uint64_t seed);
  std::span<const Vec3> directions(std::size_t set, std::size_t first, std::size_t count) const {
    return std::span(directions_[set]).subspan(first, count);
  }

 private:
  std::array<std::vector<Vec3>, kSets> directions_;
};

/// What an amount of light from a direction counts for in each quantity: max(0, cosine), and of
/// the cylinder the sine to the upright over pi. The integral of each over all directions is pi.
class Weights {
 public:
  Weights(const Vec3& normal, Up up)
      : normal_(normal), upright_(upVector(up)), cube_(cubeNormals()) {}
  std::array<double, kMeasured> of(const Vec3& toward) const;

 private:
  Vec3 normal_;
  Vec3 upright_;
  std::array<Vec3, kCubeFaces> cube_;
};

}  // namespace radiosity
