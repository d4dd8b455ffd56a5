// Errors of rows counted by rays, as estimated from replicates and from all rows together, on rows
// drawn from known distributions.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "formfactor/rays/ray_rows.h"
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

/// Rows of few hits are as far off as Poisson's distribution lets them be, whatever their
/// replicates say.
TEST(RaysAccuracy, AFewHitsDoNotTellTheError) {
  RowAccuracy row;
  row.rays = 1000;
  EXPECT_TRUE(row.isUnknown());
  EXPECT_NEAR(row.expectedError(), 0.003, 1e-5);  // the rule of three
  row.hits = 4;
  EXPECT_TRUE(row.isUnknown());
  // Garwood's upper bounds for 4 hits: 9.15 at 95%, 11.60 at 99%.
  EXPECT_NEAR(row.expectedError(), (9.154 - 4) / 1000, 1e-6);
  EXPECT_NEAR(row.figure(), (11.605 - 4) / 1000, 1e-6);
  row.hits = 1000;
  EXPECT_FALSE(row.isUnknown());
  EXPECT_EQ(row.expectedError(), 0);
  row = {};
  row.rays = 100 / kSeesNothing;
  EXPECT_FALSE(row.isUnknown()) << "nothing is there to be seen";
}

/// Of rows with one entry that is hit a few times on average, 99% are within their figures.
TEST(RaysAccuracy, FiguresHoldForRowsOfFewHits) {
  constexpr double kRays = 500;
  std::mt19937 random(9);
  for (const double mean : {0.3, 1.0, 3.0, 10.0}) {
    std::poisson_distribution<int> hits(mean / 2);
    CommonError common;
    std::vector<RowAccuracy> rows;
    for (int k = 0; k < 2000; ++k) {
      RayRow row;
      row.rays = std::uint32_t(kRays);
      row.columns = {1};
      row.hits = {{std::uint32_t(hits(random)), std::uint32_t(hits(random))}};
      rows.push_back(accuracyAlone(row, 2));
      common.add(rows.back());
    }
    int above = 0;
    for (const RowAccuracy& row : rows) {
      const double off = std::abs(row.hits - mean) / (2 * kRays);
      above += off > common.moderated(row).figure() ? 1 : 0;
    }
    // 1% and three standard deviations of 2,000 draws.
    EXPECT_LE(above, 33) << mean;
  }
}

TEST(RaysAccuracy, ForeseenVarianceFollowsHitsAndTheGainOfNets) {
  // Few hits of a small share: those of independent rays.
  const auto ofOneEnd = [](double factor, double hits) {
    return foreseenVariance(factor, hits, hitsVariance(factor, hits));
  };
  EXPECT_NEAR(ofOneEnd(1e-3, 1), 1e-6, 1e-12);
  // Many: less by the fourth root of the hits. Nearly all: by the misses. All: the next may miss.
  EXPECT_NEAR(ofOneEnd(0.5, 20000), 0.25 * 10000 / (20000.0 * 20000.0) / 10, 1e-12);
  EXPECT_LT(ofOneEnd(0.99, 10000), ofOneEnd(0.5, 10000));
  EXPECT_NEAR(ofOneEnd(1, 1000), 1e-6, 1e-18);
  EXPECT_EQ(ofOneEnd(0, 0), 0);
}

/// A small patch that sees a wall alone knows so by all of its rays; the few of the wall's that end
/// on it are a part of the merged entry, and as uncertain as ever.
TEST(RaysAccuracy, AnEntryThatIsAllOfARowIsUncertainByItsOtherEnd) {
  std::vector<RayRow> rows(2);
  rows[0].rays = 500;
  rows[0].columns = {1};
  rows[0].hits = {{500, 500}};
  rows[1].rays = 5000;
  rows[1].columns = {0};
  rows[1].hits = {{55, 45}};
  const std::vector<double> area{0.01, 1};
  std::vector<double> variance(2, -1.0);
  std::vector<double> factor(2, -1.0);
  forMergedRows(rows, area, KnownEntries(), {}, nullptr, [&](const MergedRow& merged) {
    ASSERT_EQ(merged.variances.size(), 1u);
    variance[merged.position] = merged.variances[0];
    factor[merged.position] = 0.5 * (merged.factors[0][0] + merged.factors[0][1]);
  });
  EXPECT_NEAR(factor[0], 1, 1e-12);
  EXPECT_NEAR(factor[1], 0.01, 1e-12);
  const double of_hits = hitsVariance(0.01, 100);
  EXPECT_NEAR(variance[0], foreseenVariance(1, 1100, of_hits), 1e-15);
  // Relative errors of a pair are the same from both ends.
  EXPECT_NEAR(variance[1], 1e-4 * variance[0], 1e-15);
}

/// What two patches of few rays see of each other may be missed from both ends, however often the
/// many rays of a third one hit them.
TEST(RaysAccuracy, HitsByOneOtherRowDoNotTellOfTheRest) {
  std::vector<RayRow> rows(3);
  rows[0].rays = 1000;
  rows[1].rays = 1000;
  rows[2].rays = 1000000;
  rows[2].columns = {0};
  rows[2].hits = {{50, 50}};
  const std::vector<double> area{1, 1, 1};
  std::vector<RowAccuracy> accuracy(3);
  forMergedRows(rows, area, KnownEntries(), {}, nullptr, [&](const MergedRow& merged) {
    const std::size_t k = merged.position;
    accuracy[k] = accuracyOf(merged, rows[k], area[k]);
  });
  EXPECT_TRUE(accuracy[0].isUnknown());
  EXPECT_NEAR(accuracy[0].hits, 2000 * 50 / 1001000.0, 1e-9);
  EXPECT_TRUE(accuracy[1].isUnknown());
  EXPECT_FALSE(accuracy[2].isUnknown());
}

}  // namespace
}  // namespace radiosity
