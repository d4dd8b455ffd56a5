// The interpolation kernels on every instruction set: the scalar target's bits, and the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "gather/interpolation_kernels.h"
#include "support/simd_targets.h"

namespace radiosity {
namespace {

using Rises = std::vector<std::array<double, 4>>;

template <class Check>
void forEveryTarget(const Check& check) {
  test::onEveryTarget([] { return interpolationKernels(true); }, check);
}

/// A facet whose outline is met by the row at random places: some pixels lie outside some edges.
/// `rises`: one a band, kept by reference.
FacetRow randomFacet(std::mt19937_64& random, Rises& rises) {
  std::uniform_real_distribution<double> signed_unit(-1, 1);
  std::uniform_real_distribution<double> positive(0.1, 2);
  FacetRow facet;
  for (std::size_t k = 0; k < 4; ++k) {
    facet.slope[k] = 0.02 * signed_unit(random);
    facet.base[k] = positive(random) - 0.2;
    facet.area[k] = positive(random);
    for (auto& rise : rises) rise[k] = signed_unit(random);
  }
  facet.rise = rises;
  return facet;
}

/// Running sums of weights of 0.5 to 1; nothing may be read beyond the last.
std::vector<double> runningSums(std::size_t pixels, std::mt19937_64& random) {
  std::uniform_real_distribution<double> weight(0.5, 1);
  std::vector<double> sums(pixels + 1, 0.0);
  for (std::size_t x = 0; x < pixels; ++x) sums[x + 1] = sums[x] + weight(random);
  return sums;
}

bool same(const std::vector<LaneSums>& a, const std::vector<LaneSums>& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](const LaneSums& s, const LaneSums& t) { return s.sum == t.sum; });
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
        const std::size_t bands = std::size_t(count) % 5 + 1;
        Rises rises(bands);
        FacetRow facet = randomFacet(random, rises);
        if (count % 7 == 3) facet.slope = facet.base = {};  // seen as a point
        std::vector<LaneSums> a(bands);
        std::vector<LaneSums> b(bands);
        scalar.addTriangle(facet, pixels, a.data());
        kernels.addTriangle(facet, pixels, b.data());
        EXPECT_TRUE(same(a, b)) << count << " + " << beyond;
        scalar.addQuad(facet, pixels, a.data());  // on top of what is there
        kernels.addQuad(facet, pixels, b.data());
        EXPECT_TRUE(same(a, b)) << count << " + " << beyond;
      }
    }
  });
}

TEST(InterpolationKernels, ABandHasTheSameBitsAloneAndAmongOthers) {
  forEveryTarget([&](const InterpolationKernels& kernels) {
    std::mt19937_64 random(7);
    const std::vector<double> weights = runningSums(50, random);
    const PixelRow pixels{weights.data(), -20.5, 43, 50};
    Rises rises(8);
    const FacetRow facet = randomFacet(random, rises);
    std::vector<LaneSums> all(8);
    kernels.addQuad(facet, pixels, all.data());
    kernels.addTriangle(facet, pixels, all.data());
    for (std::size_t b = 0; b < rises.size(); ++b) {
      FacetRow one = facet;
      one.rise = {&rises[b], 1};
      LaneSums alone;
      kernels.addQuad(one, pixels, &alone);
      kernels.addTriangle(one, pixels, &alone);
      EXPECT_EQ(alone.sum, all[b].sum) << b;
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
  Rises rises(3);
  for (std::size_t b = 0; b < 3; ++b) rises[b][b + 1] = 1;
  square.rise = rises;
  triangle.rise = {rises.data(), 2};
  std::vector<double> weights(11);
  std::iota(weights.begin(), weights.end(), 0.0);
  const auto total = [](const std::array<double, kLanes>& lanes) {
    return std::accumulate(lanes.begin(), lanes.end(), 0.0);
  };
  forEveryTarget([&](const InterpolationKernels& kernels) {
    std::array<LaneSums, 3> four{};
    kernels.addQuad(square, {weights.data(), 0.5, 10, 10}, four.data());
    EXPECT_NEAR(total(four[0].sum), 5 * 0.7, 1e-14);
    EXPECT_NEAR(total(four[1].sum), 5 * 0.3, 1e-14);
    EXPECT_NEAR(total(four[2].sum), 5 * 0.3, 1e-14);
    std::array<LaneSums, 2> three{};
    kernels.addTriangle(triangle, {weights.data(), 0.5, 7, 10}, three.data());  // x to 0.7
    EXPECT_NEAR(total(three[0].sum), 0.5 * 7 * 0.7, 1e-14);
    EXPECT_NEAR(total(three[1].sum), 7 * 0.3, 1e-14);
  });
}

}  // namespace
}  // namespace radiosity
