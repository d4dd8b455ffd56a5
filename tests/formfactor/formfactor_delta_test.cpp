// Delta form factors against their known sums, and against the integrand.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "formfactor/hemicube/delta_form_factors.h"

namespace radiosity {
namespace {

double sum(const DeltaFormFactors& weights) {
  const int n = weights.resolution();
  double total = 0;
  for (int y = 0; y < n; ++y) total += weights.topRow(y)[n];
  for (int y = 0; y < n / 2; ++y) total += 4 * weights.sideRow(y)[n];
  return total;
}

TEST(DeltaFormFactors, SumOverTheHemicubeIsOne) {
  // A row's total is right to a few units in the last place of the corner integrals (1e-17), and
  // at most 3 * 1024 rows are added.
  for (const int n : {16, 18, 32, 64, 100, 128, 256, 512, 1024}) {
    EXPECT_NEAR(sum(DeltaFormFactors(n)), 1.0, 1e-14) << n;
  }
}

TEST(DeltaFormFactors, TopFaceIsWorthItsConfigurationFactor) {
  // Four quadrants of B-3 with unit sides, FIELD value 0.138531605994893 (Howell's catalogue).
  const DeltaFormFactors weights(64);
  double top = 0;
  for (int y = 0; y < 64; ++y) top += weights.topRow(y)[64];
  EXPECT_NEAR(top, 4 * 0.138531605994893, 1e-14);  // the value is given to 15 digits
}

TEST(DeltaFormFactors, PixelsFollowTheIntegrand) {
  // The midpoint rule is exact to second order in the pixel's size: h^2/24 times a second
  // derivative of at most about 12 times the value, h = 2/256.
  const int n = 256;
  const double h = 2.0 / n;
  const DeltaFormFactors weights(n);
  for (int y = 0; y < n; y += 5) {
    for (int x = 0; x < n; x += 7) {
      const double px = (x + 0.5) * h - 1;
      const double py = (y + 0.5) * h - 1;
      const double top = h * h * std::numbers::inv_pi / std::pow(px * px + py * py + 1, 2);
      EXPECT_NEAR(weights.topRow(y)[x + 1] - weights.topRow(y)[x], top, 5e-5 * top);
      if (y >= n / 2) continue;
      const double pz = (y + 0.5) * h;
      const double side = pz * h * h * std::numbers::inv_pi / std::pow(px * px + pz * pz + 1, 2);
      EXPECT_NEAR(weights.sideRow(y)[x + 1] - weights.sideRow(y)[x], side, 5e-5 * side);
    }
  }
}

TEST(DeltaFormFactors, AreNotPixelCounts) {
  // The share of pixels on the top face is 1/3, their worth 0.554.
  const DeltaFormFactors weights(32);
  double top = 0;
  for (int y = 0; y < 32; ++y) top += weights.topRow(y)[32];
  EXPECT_GT(top, 1.5 / 3);
}

}  // namespace
}  // namespace radiosity
