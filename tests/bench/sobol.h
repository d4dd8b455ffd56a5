// Owen-scrambled Sobol points in four dimensions, for the ray caster that the benchmark sets its
// subject against.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace radiosity::bench {

inline constexpr int kDimensions = 4;
/// Points are made this many at a time: their raw table (64 KiB) stays in the second-level cache.
inline constexpr std::size_t kBlock = 4096;

/// kBlock points in [0, 1)^4, dimension after dimension.
using PointBlock = std::array<std::array<float, kBlock>, kDimensions>;

/// The first points of the Sobol sequence (direction numbers: S. Joe, F. Kuo, "Constructing Sobol
/// sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30, 2008), each
/// dimension scrambled by a nested uniform permutation as a hash (B. Burley, "Practical Hash-based
/// Owen Scrambling", JCGT 9(4), 2020). Different seeds give independent scramblings; 2^m points are
/// a digital net whatever the seed.
class SobolPoints {
 public:
  SobolPoints();

  /// `count` points from block * kBlock on, scrambled by `seed`.
  void block(std::uint32_t block, std::size_t count, std::uint64_t seed, PointBlock& out) const;

 private:
  /// Bits reversed: digit 1 after the point is bit 0, which is how the scrambling hash wants them.
  std::array<std::array<std::uint32_t, kBlock>, kDimensions> first_;
  std::array<std::array<std::uint32_t, 32>, kDimensions> direction_;
};

/// True if the first 2^m points have exactly one in each of the 2^m equal intervals, in every
/// dimension, for m = 0 to 12 and a few seeds: what makes them a net, and what a wrong direction
/// number or a hash that is no nested permutation destroys.
bool sobolPointsAreStratified();

}  // namespace radiosity::bench
