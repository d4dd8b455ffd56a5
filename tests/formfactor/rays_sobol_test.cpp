// The points of the rays' origins and directions.
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "formfactor/rays/sobol.h"

namespace radiosity {
namespace {

using Points = std::array<std::vector<float>, kDimensions>;

Points pointsOf(std::uint32_t first, std::size_t count, std::uint64_t seed) {
  static const SobolPoints sobol;
  Points points;
  PointArrays out{};
  for (std::size_t d = 0; d < kDimensions; ++d) {
    points[d].resize(count);
    out[d] = points[d].data();
  }
  sobol.points(first, count, seed, out);
  return points;
}

/// A wrong direction number, or a hash that is no nested permutation, destroys this.
TEST(SobolPoints, HaveOneInEachOfTwoToTheMIntervals) {
  for (const std::uint64_t seed : {1ull, 2ull, 12345678901234ull}) {
    for (const std::uint32_t first : {0u, 3u * std::uint32_t(kMostPoints)}) {
      for (const std::vector<float>& coordinates : pointsOf(first, kMostPoints, seed)) {
        for (std::size_t count = 1; count <= kMostPoints; count *= 2) {
          std::vector<char> taken(count, 0);
          for (std::size_t k = 0; k < count; ++k) {
            char& mark = taken[std::size_t(coordinates[k] * float(count))];
            ASSERT_EQ(mark, 0) << count;
            mark = 1;
          }
        }
      }
    }
  }
}

TEST(SobolPoints, FirstTwoDimensionsFillEveryCellOfASquareOnce) {
  constexpr std::size_t kSide = 64;
  const Points points = pointsOf(0, kSide * kSide, 7);
  std::vector<char> taken(kSide * kSide, 0);
  for (std::size_t k = 0; k < kSide * kSide; ++k) {
    const auto x = std::size_t(points[0][k] * kSide);
    const auto y = std::size_t(points[1][k] * kSide);
    ASSERT_EQ(taken[x * kSide + y], 0);
    taken[x * kSide + y] = 1;
  }
}

TEST(SobolPoints, AreTheSameInPiecesAsAtOnce) {
  const Points all = pointsOf(0, 2048, 5);
  for (const auto& [first, count] :
       {std::pair{0u, 512u}, {512u, 512u}, {1024u, 512u}, {1536u, 512u}}) {
    const Points piece = pointsOf(first, count, 5);
    for (std::size_t d = 0; d < kDimensions; ++d) {
      for (std::size_t k = 0; k < count; ++k) ASSERT_EQ(piece[d][k], all[d][first + k]);
    }
  }
}

}  // namespace
}  // namespace radiosity
