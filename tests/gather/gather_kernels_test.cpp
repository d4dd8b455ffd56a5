// The interpolation kernels on every instruction set: the scalar target's bits, and the definition.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "gather/interpolation_kernels.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

template <class Check>
void forEveryTarget(const Check& check) {
  test::onEveryTarget([] { return interpolationKernels(true); }, check);
}

/// A facet whose outline is met by the row at random places: some pixels lie outside some edges.
FacetRow randomFacet(std::mt19937_64& random) {
  std::uniform_real_distribution<double> signed_unit(-1, 1);
  std::uniform_real_distribution<double> positive(0.1, 2);
  FacetRow facet;
  for (std::size_t k = 0; k < 4; ++k) {
    facet.slope[k] = 0.02 * signed_unit(random);
    facet.base[k] = positive(random) - 0.2;
    facet.area[k] = positive(random);
    for (std::size_t b = 0; b < 3; ++b) facet.rise[b][k] = signed_unit(random);
  }
  return facet;
}

/// Running sums of weights of 0.5 to 1; nothing may be read beyond the last.
std::vector<double> runningSums(std::size_t pixels, std::mt19937_64& random) {
  std::uniform_real_distribution<double> weight(0.5, 1);
  std::vector<double> sums(pixels + 1, 0.0);
  for (std::size_t x = 0; x < pixels; ++x) sums[x + 1] = sums[x] + weight(random);
  return sums;
}

TEST(InterpolationKernels, EveryInstructionSetGivesTheSameBits) {
  const InterpolationKernels scalar = interpolationKernels(false);
  forEveryTarget([&](const InterpolationKernels& kernels) {
    std::mt19937_64 random(5);
    for (int count = 0; count < 60; ++count) {
      for (const int beyond : {0, 1, 30}) {
        const int readable = count + beyond;
        const std::vector<double> weights = runningSums(std::size_t(readable), random);
        const PixelRow pixels{weights.data(), -20.5, count, readable};
        FacetRow facet = randomFacet(random);
        if (count % 7 == 3) facet.slope = facet.base = {};  // seen as a point
        LaneSums a;
        LaneSums b;
        scalar.addTriangle(facet, pixels, a);
        kernels.addTriangle(facet, pixels, b);
        EXPECT_EQ(a.sum, b.sum) << count << " + " << beyond;
        scalar.addQuad(facet, pixels, a);  // on top of what is there
        kernels.addQuad(facet, pixels, b);
        EXPECT_EQ(a.sum, b.sum) << count << " + " << beyond;
      }
    }
  });
}

TEST(InterpolationKernels, WeightsOfCornersAreWachspressAndBarycentric) {
  // A unit square seen face on has A_0..3 = y, 1 - x, 1 - y, x (edges from (0,0) on) and C_k = 1:
  // corner 1, 2, 3 weigh x (1 - y), x y, (1 - x) y. On the row y = 0.3, x = (m + 0.5) / 10.
  FacetRow square;
  square.area = {1, 1, 1, 1};
  square.slope = {0, -0.1, 0, 0.1};
  square.base = {0.3, 1, 0.7, 0};
  FacetRow triangle = square;  // corners (0,0), (1,0), (0,1): A = y, 1 - x - y, x
  triangle.slope = {0, -0.1, 0.1, 0};
  triangle.base = {0.3, 0.7, 0, 0};
  for (std::size_t b = 0; b < 3; ++b) square.rise[b][b + 1] = 1;
  for (std::size_t b = 0; b < 2; ++b) triangle.rise[b][b + 1] = 1;
  std::vector<double> weights(11);
  std::iota(weights.begin(), weights.end(), 0.0);
  const auto total = [](const std::array<double, kLanes>& lanes) {
    return std::accumulate(lanes.begin(), lanes.end(), 0.0);
  };
  forEveryTarget([&](const InterpolationKernels& kernels) {
    LaneSums four;
    kernels.addQuad(square, {weights.data(), 0.5, 10, 10}, four);
    EXPECT_NEAR(total(four.sum[0]), 5 * 0.7, 1e-14);
    EXPECT_NEAR(total(four.sum[1]), 5 * 0.3, 1e-14);
    EXPECT_NEAR(total(four.sum[2]), 5 * 0.3, 1e-14);
    LaneSums three;
    kernels.addTriangle(triangle, {weights.data(), 0.5, 7, 10}, three);  // x to 0.7
    EXPECT_NEAR(total(three.sum[0]), 0.5 * 7 * 0.7, 1e-14);
    EXPECT_NEAR(total(three.sum[1]), 7 * 0.3, 1e-14);
  });
}

}  // namespace
}  // namespace radiosity
