#include "formfactor/exact/occluded/part_error.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "formfactor/exact/error_model.h"
#include "formfactor/exact/occluded/cell_rule.h"

namespace radiosity {
namespace {

/// The point in the middle, among a part's, and its weight in the rule of 3 x 3.
constexpr std::size_t kMiddle = 8;
constexpr double kMiddleWeight = 64.0 / 324;

/// Of the mean, however little the rules differ: they may agree by chance. Values that bend so much
/// over a part have higher terms: the sixth, of which 3 x 3 points know nothing, falls as the cube
/// of the second.
double leastError(const std::array<double, PartValues::kPoints>& residual, double largest) {
  const double bend = bendOf(std::span(residual).subspan<PartValues::kCoarse, 9>());
  const double share = std::min(1.0, bend / (2 * largest));
  return kCellSmooth9 * bend * share * share;
}

}  // namespace

double PartValues::integral(const std::array<double, kPoints>& values) const {
  double sum = 0;
  for (std::size_t q = kCoarse; q < kPoints; ++q) sum += weight[q] * values[q];
  return sum;
}

double PartValues::coarseIntegral(const std::array<double, kPoints>& values) const {
  double sum = 0;
  for (std::size_t q = 0; q < kCoarse; ++q) sum += weight[q] * values[q];
  return sum;
}

double PartValues::error(double fraction, bool near) const {
  std::array<double, kPoints> residual;
  double largest = 0;
  for (std::size_t q = 0; q < kPoints; ++q) {
    residual[q] = visible[q] - fraction * whole[q];
    largest = std::max(largest, std::abs(residual[q]));
  }
  if (!(largest > 0)) return 0;
  const double least = area * leastError(residual, largest);
  const double fine = integral(residual);
  const double coarse = coarseIntegral(residual);
  const double difference = std::abs(fine - coarse);
  if (overlap) return kPartOverlap * difference;
  if (!(difference > 0)) return least;
  const double middle = residual[kMiddle] * weight[kMiddle] / kMiddleWeight;
  const double before = std::max(std::abs(coarse - middle), difference);
  const double share = std::max(kPartFactor * difference / before,
                                kPartOrder * std::sqrt(difference / (largest * area)));
  const double estimate =
      difference * std::clamp(share, one_shape && !near ? kPartLeast : kPartLeastDoubtful, 1.0);
  return std::max(estimate, least);
}

}  // namespace radiosity
