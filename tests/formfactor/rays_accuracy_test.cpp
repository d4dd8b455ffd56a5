// Errors of rows counted by rays, as estimated from replicates and from all rows together, on rows
// drawn from known distributions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "formfactor/rays/row_accuracy.h"

namespace radiosity {
namespace {

/// A row of some entries whose replicates are off by normal errors, and how far its mean is off.
struct DrawnRow {
  RowAccuracy accuracy;
  double off = 0;  ///< squared
};

/// `sigma`: of the mean of both replicates; foreseen are variances of sigma^2 / `scale`.
DrawnRow draw(const std::vector<double>& sigma, double scale, std::mt19937& random) {
  constexpr double kFactor = 0.1;
  std::normal_distribution<double> normal;
  DrawnRow row;
  ReplicateSums sums;
  for (const double s : sigma) {
    const double first = s * std::sqrt(2.0) * normal(random);
    const double second = s * std::sqrt(2.0) * normal(random);
    sums.add(kFactor + first, kFactor + second, s * s / scale);
    row.off += 0.25 * (first + second) * (first + second);
  }
  row.accuracy = sums.accuracy();
  return row;
}

/// Most of a row's error comes from one entry, as with a lamp or a wall close by.
const std::vector<double> kOneLargeEntry{0.01, 0.001, 0.001};

TEST(RaysAccuracy, ModeratedRowsDoNotStopByChance) {
  constexpr double kAim = 0.005;  // half the true error: no row should stop
  std::mt19937 random(1);
  std::vector<DrawnRow> rows;
  CommonError common;
  for (int k = 0; k < 2000; ++k) {
    rows.push_back(draw(kOneLargeEntry, 0.7, random));
    common.add(rows.back().accuracy);
  }
  std::size_t stopped_alone = 0;
  std::size_t stopped = 0;
  double stated = 0;
  double off = 0;
  for (const DrawnRow& row : rows) {
    stopped_alone += row.accuracy.error <= kAim ? 1 : 0;
    const RowAccuracy moderated = common.moderated(row.accuracy);
    stopped += moderated.error <= kAim ? 1 : 0;
    stated += moderated.error * moderated.error;
    off += row.off;
  }
  // |N(0, 1)| is below 1/2 in 38% of draws.
  EXPECT_NEAR(double(stopped_alone) / double(rows.size()), 0.38, 0.05);
  EXPECT_EQ(stopped, 0u);
  // Both are means of 2,000 squares of normal errors: each to 3% (one standard deviation).
  EXPECT_NEAR(stated / off, 1, 0.15);
}

/// Rows whose errors differ from the forecast differently keep estimates of their own.
TEST(RaysAccuracy, FiguresHoldForRowsOfDifferentErrors) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> exponent(-1, 1);
  std::vector<DrawnRow> rows;
  CommonError common;
  for (int k = 0; k < 4000; ++k) {
    rows.push_back(draw(kOneLargeEntry, std::pow(4.0, exponent(random)), random));
    common.add(rows.back().accuracy);
  }
  std::size_t above = 0;
  for (const DrawnRow& row : rows) {
    const RowAccuracy moderated = common.moderated(row.accuracy);
    EXPECT_GT(moderated.degrees, row.accuracy.degrees);
    above += std::sqrt(row.off) > moderated.figure() ? 1 : 0;
  }
  // 1% and three standard deviations of 4,000 draws.
  EXPECT_LT(double(above) / double(rows.size()), 0.0147);
  EXPECT_GT(above, 0u);
}

TEST(RaysAccuracy, ARowWithoutHitsHasAnErrorFigure) {
  RowAccuracy row;
  row.rays = 1000;
  // .99 of rows without hits see less than this: (1 - f)^1000 = .01.
  EXPECT_NEAR(row.figure(), 0.0046, 1e-4);
  row.rays = 0;  // known, not counted
  EXPECT_EQ(row.figure(), 0);
}

TEST(RaysAccuracy, ForeseenVarianceFollowsHitsAndTheGainOfNets) {
  // Few hits of a small share: those of independent rays.
  EXPECT_NEAR(foreseenVariance(1e-3, 1), 1e-6 * (1 - 1e-3), 1e-12);
  // Many: less by the fourth root of the hits. Nearly all: by the misses.
  EXPECT_NEAR(foreseenVariance(0.5, 20000), 0.25 * 10000 / (20000.0 * 20000.0) / 10, 1e-12);
  EXPECT_LT(foreseenVariance(0.99, 10000), foreseenVariance(0.5, 10000));
  EXPECT_EQ(foreseenVariance(1, 1000), 0);
  EXPECT_EQ(foreseenVariance(0, 0), 0);
}

}  // namespace
}  // namespace radiosity
