#include "formfactor/exact/occluded/part_error.h"

#include <algorithm>
#include <cmath>

#include "formfactor/exact/error_model.h"

namespace radiosity {
namespace {

/// The point in the middle, among a part's, and its weight in the rule of 3 x 3.
constexpr std::size_t kMiddle = 8;
constexpr double kMiddleWeight = 64.0 / 324;

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
  const double fine = integral(residual);
  const double coarse = coarseIntegral(residual);
  const double difference = std::abs(fine - coarse);
  if (overlap) return kPartOverlap * difference;
  if (!(difference > 0)) return 0;
  const double middle = residual[kMiddle] * weight[kMiddle] / kMiddleWeight;
  const double before = std::max(std::abs(coarse - middle), difference);
  const double share = std::max(kPartFactor * difference / before,
                                kPartOrder * std::sqrt(difference / (largest * area)));
  return difference * std::clamp(share, one_shape && !near ? kPartLeast : kPartLeastDoubtful, 1.0);
}

}  // namespace radiosity
