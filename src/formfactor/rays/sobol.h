// Owen-scrambled Sobol points in four dimensions: two place a ray on its patch, two turn it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace radiosity {

inline constexpr int kDimensions = 4;
/// Points are made at most this many at a time: their raw table (64 KiB) stays in the second-level
/// cache.
inline constexpr std::size_t kMostPoints = 4096;

/// Arrays for each dimension's values, in [0, 1).
using PointArrays = std::array<float*, kDimensions>;

/// The first points of the Sobol sequence (direction numbers: S. Joe, F. Kuo, "Constructing Sobol
/// sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30, 2008), each
/// dimension scrambled by a nested uniform permutation as a hash (B. Burley, "Practical Hash-based
/// Owen Scrambling", JCGT 9(4), 2020). Different seeds give independent scramblings; 2^m points are
/// a digital net whatever the seed.
class SobolPoints {
 public:
  SobolPoints();

  /// Points `first` to `first + count` of the sequence, scrambled by `seed`. `count`: at most
  /// kMostPoints and at most the largest power of two that divides `first`.
  void points(std::uint32_t first, std::size_t count, std::uint64_t seed,
              const PointArrays& out) const;

 private:
  /// Bits reversed: digit 1 after the point is bit 0, which is how the scrambling hash wants them.
  std::array<std::array<std::uint32_t, kMostPoints>, kDimensions> first_;
  std::array<std::array<std::uint32_t, 32>, kDimensions> direction_;
};

}  // namespace radiosity
