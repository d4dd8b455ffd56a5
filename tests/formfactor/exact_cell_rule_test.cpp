// The errors that the points of a cell state, on random shadows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "formfactor/exact/occluded/cell_error.h"
#include "formfactor/exact/occluded/cell_rule.h"

namespace radiosity {
namespace {

const SampleCell kUnitCell = {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}};

/// A shadow with a straight edge that crosses a target with parallel sides: the visible fraction
/// is 0, rises linearly over a strip of the cell, and is 1 from there on.
struct Ramp {
  double nx, ny, start, width;

  double at(const Vec3& p) const {
    return std::clamp((nx * p.x + ny * p.y - start) / width, 0.0, 1.0);
  }
  /// Which of the three parts a point is in.
  int part(const Vec3& p) const {
    const double t = nx * p.x + ny * p.y - start;
    return (t > 0 ? 1 : 0) + (t > width ? 1 : 0);
  }
  /// Mean over a square: midpoints of 64 x 64 parts, a hundred times nearer than nine points.
  double mean(const SampleCell& square) const {
    constexpr int kSide = 64;
    const Vec3 u = (square.corners[1] - square.corners[0]) / double(kSide);
    const Vec3 v = (square.corners[3] - square.corners[0]) / double(kSide);
    double sum = 0;
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) sum += at(square.corners[0] + (i + 0.5) * u + (j + 0.5) * v);
    }
    return sum / (kSide * kSide);
  }
};

/// Of any direction, so that some of the strip lies in the unit square.
Ramp randomRamp(double change, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double angle = 2 * std::numbers::pi * unit(random);
  Ramp ramp{std::cos(angle), std::sin(angle), 0, 1 / change};
  const double low = std::min(0.0, ramp.nx) + std::min(0.0, ramp.ny) - ramp.width;
  const double high = std::max(0.0, ramp.nx) + std::max(0.0, ramp.ny);
  ramp.start = low + (high - low) * unit(random);
  return ramp;
}

/// Root mean squares over many shadows.
struct Errors {
  CellError estimate;
  double found = 0;
};

/// In cells `level` halvings below the unit square.
Errors errorsOfRamps(double change, std::size_t side, int level) {
  std::mt19937 random(7);
  Errors errors;
  constexpr int kTimes = 4000;
  for (int k = 0; k < kTimes; ++k) {
    const Ramp ramp = randomRamp(change, random);
    SampleCell cell = kUnitCell;
    for (int l = 0; l < level; ++l) cell = cell.child(random() % 4);
    const SamplePoints points = cell.points(side);
    CellValues values;
    values.count = points.count;
    values.whole = 1;
    values.side = std::ldexp(1.0, -level);
    values.change = changeIn(level, change);
    double mean = 0;
    for (std::size_t q = 0; q < points.count; ++q) {
      const Vec3& p = points.point[q].position;
      values.residual[q] = ramp.at(p);
      values.one_shape &= ramp.part(p) == ramp.part(points.point[0].position);
      mean += points.point[q].weight / cell.area() * ramp.at(p);
    }
    const double found = mean - ramp.mean(cell);
    values.fraction = mean;
    values.one_occluder = true;
    const CellError error = meanError(values);
    errors.found += found * found / kTimes;
    errors.estimate.cautious += error.cautious * error.cautious / kTimes;
    errors.estimate.stated += error.stated * error.stated / kTimes;
  }
  return {{std::sqrt(errors.estimate.cautious), std::sqrt(errors.estimate.stated)},
          std::sqrt(errors.found)};
}

TEST(SampleCell, RandomShadowEdgesHaveErrorsNearTheEstimates) {
  // From shadows that cross the target once while the element is crossed to steps, seen or missed.
  // Constants were fitted to scenes, not to these shadows: over all cells the cautious estimate was
  // measured at half to two and a half times the error found, the stated one at three quarters to
  // four times; 3 and 5 either way are asserted.
  for (const auto& [side, levels] : {std::pair(2, 1), std::pair(3, 5)}) {
    for (int level = 0; level < levels; ++level) {
      for (const double change : {1.0, 4.0, 10.0, 100.0}) {
        const Errors errors = errorsOfRamps(change, std::size_t(side), level);
        EXPECT_GT(errors.estimate.cautious, errors.found / 3)
            << side << ' ' << level << ' ' << change;
        EXPECT_LT(errors.estimate.cautious, errors.found * 3)
            << side << ' ' << level << ' ' << change;
        EXPECT_GT(errors.estimate.stated, errors.found / 5)
            << side << ' ' << level << ' ' << change;
        EXPECT_LT(errors.estimate.stated, errors.found * 5)
            << side << ' ' << level << ' ' << change;
      }
    }
  }
}

/// Nine points that see the same fraction of a target.
CellValues flatValues(double fraction) {
  CellValues values;
  values.count = 9;
  values.whole = 1;
  values.change = 0.5;
  values.fraction = fraction;
  values.residual.fill(0.0);
  return values;
}

TEST(SampleCell, AnEdgeSeenFromEveryPointLowersTheStatedError) {
  CellValues edge = flatValues(0.4);
  edge.one_occluder = true;
  CellValues none = flatValues(1);
  none.one_occluder = true;
  EXPECT_EQ(meanError(none).stated, meanError(none).cautious);
  EXPECT_GT(meanError(none).stated, 0);
  EXPECT_LT(meanError(edge).stated, meanError(none).stated);
  EXPECT_EQ(meanError(edge).cautious, meanError(none).cautious);
  // One occluder's edge tells nothing of another's.
  edge.one_occluder = false;
  EXPECT_EQ(meanError(edge).stated, meanError(edge).cautious);
}

TEST(SampleCell, SlowShadowsLowerTheErrorStatedForKinks) {
  const auto statedShare = [](double step) {
    CellValues values = flatValues(0.5);
    values.change = 0;
    values.one_shape = false;
    values.residual = {0, 0, 0, step, step, step, 0, 0, 0};
    const CellError error = meanError(values);
    return error.stated / error.cautious;
  };
  // As the root of the movement.
  EXPECT_NEAR(statedShare(0.08) / statedShare(0.02), 2, 1e-12);
  EXPECT_LT(statedShare(0.1), 1);
  EXPECT_GT(statedShare(0.4), 1);
}

TEST(SampleCell, AConstantViewStatesNoError) {
  CellValues values;
  values.count = 9;
  values.whole = 1;
  values.residual.fill(0.0);
  EXPECT_EQ(meanError(values).cautious, 0);
  EXPECT_EQ(meanError(values).stated, 0);
}

}  // namespace
}  // namespace radiosity
