#include "formfactor/rays/row_accuracy.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "formfactor/rays/ray_model.h"

namespace radiosity {
namespace {

constexpr double kStated = 0.99;
constexpr double kExpected = 0.95;
/// Rows that are proved to see nothing have bounds below this (kSeesNothing).
constexpr double kNothing = 1e-20;

/// In a share `stated` of cases, no more hits than this were to be expected beyond the `hits` that
/// there are (the exact bound of Poisson's distribution: F. Garwood, Biometrika 28, 1936).
double missedHits(double hits, double stated) {
  return boost::math::gamma_q_inv(hits + 1, 1 - stated) - hits;
}

}  // namespace

double RowAccuracy::figure() const {
  const double estimated = std::hypot(error, backs_error);
  double seen = known_error;
  if (estimated > 0) {
    const boost::math::fisher_f distribution(terms, degrees);
    seen = std::hypot(estimated * std::sqrt(boost::math::quantile(distribution, kStated)),
                      known_error);
  }
  // In 99% of rows, one of the rays hits any part that takes more than this share of the row.
  const double unseen = missedHits(isUnknown() ? hits : 0, kStated);
  return std::hypot(std::max(seen, rays > 0 ? std::min(1.0, unseen / rays) : 0.0), unresolved);
}

bool RowAccuracy::isUnknown() const {
  return rays > 0 && hits < kFewHits && missedHits(hits, kExpected) / rays > kNothing;
}

double RowAccuracy::expectedError() const {
  if (!isUnknown()) return error;
  return std::max(error, std::min(1.0, missedHits(hits, kExpected) / rays));
}

RowAccuracy ReplicateSums::accuracy() const {
  RowAccuracy result;
  // The product of independent estimates has no bias, the square of their mean has.
  result.norm = std::sqrt(std::max(0.0, product_));
  result.error = std::sqrt(squares_);
  result.foreseen = std::sqrt(foreseen_);
  if (foreseen_squares_ > 0) {
    result.terms = std::max(1.0, foreseen_ * foreseen_ / (kEntriesATerm * foreseen_squares_));
  }
  result.degrees = result.terms;
  return result;
}

double hitsVariance(double share, double hits) { return hits * std::max(0.0, 1 - share); }

double pairHitsVariance(double factor, const std::array<double, 2>& hits,
                        const std::array<double, 2>& area) {
  return hitsVariance(factor, hits[0]) + hitsVariance(factor * area[0] / area[1], hits[1]);
}

double foreseenVariance(double factor, double hits, double of_hits) {
  if (!(hits > 0)) return 0;
  const double of_net = std::pow(std::max(1.0, of_hits), 1 - kGain);
  return factor * factor * of_net / (hits * hits);
}

void CommonError::add(const RowAccuracy& row) {
  if (!(row.foreseen > 0)) return;
  const double ratio = (row.error * row.error) / (row.foreseen * row.foreseen);
  rows_ += 1;
  degrees_ += row.degrees;
  ratios_ += ratio;
  squares_ += ratio * ratio / (1 + 2 / row.degrees);
}

RowAccuracy CommonError::moderated(const RowAccuracy& row) const {
  RowAccuracy result = row;
  if (!(row.foreseen > 0)) return result;
  const double mean = ratios_ / rows_;
  // The scatter of rows' own ratios: their variance over their mean squared.
  const double spread = std::max(0.0, squares_ / rows_ / (mean * mean) - 1);
  const double common = mean * row.foreseen * row.foreseen;
  // The common estimate weighs as one of this many degrees, and of no more than there are.
  double weight = degrees_;
  if (spread > 0) weight = std::min(weight, 2 * (1 + 1 / spread));
  result.degrees = row.degrees + weight;
  result.error =
      std::sqrt((row.degrees * row.error * row.error + weight * common) / result.degrees);
  return result;
}

}  // namespace radiosity
