#include "mesh/cells/edge_grading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radiosity {

namespace {

constexpr double kSizeGrowth = std::numbers::ln2;

/// The measure m(t) = integral of 1/s from 0 to t, and its inverse. s has up to three parts: it
/// rises from `start` until t = rise, is constant, and falls from t = fall on to `end`.
class Measure {
 public:
  Measure(double length, const EdgeSize& wanted)
      : length_(length),
        start_(std::min(wanted.start, wanted.size)),
        end_(std::min(wanted.end, wanted.size)),
        size_(wanted.size),
        rise_((size_ - start_) / kSizeGrowth),
        fall_(length - (size_ - end_) / kSizeGrowth) {
    if (rise_ > fall_) {  // the slopes meet below `size`
      rise_ = fall_ = std::clamp(0.5 * (length + (end_ - start_) / kSizeGrowth), 0.0, length);
      size_ = start_ + kSizeGrowth * rise_;
    }
    rising_ = std::log1p(kSizeGrowth * rise_ / start_) / kSizeGrowth;
    constant_ = (fall_ - rise_) / size_;
    total_ = rising_ + constant_ + std::log1p(kSizeGrowth * (length - fall_) / end_) / kSizeGrowth;
  }

  double total() const { return total_; }

  double inverse(double m) const {
    if (m < rising_) return start_ * std::expm1(kSizeGrowth * m) / kSizeGrowth;
    if (m < rising_ + constant_) return rise_ + (m - rising_) * size_;
    return length_ - end_ * std::expm1(kSizeGrowth * (total_ - m)) / kSizeGrowth;
  }

 private:
  double length_;
  double start_;
  double end_;
  double size_;
  double rise_;
  double fall_;
  double rising_ = 0;
  double constant_ = 0;
  double total_ = 0;
};

bool isGraded(const EdgeSize& wanted) {
  return wanted.start < wanted.size || wanted.end < wanted.size;
}

/// The ends of the parts between stops.
std::vector<double> partEnds(const EdgeSize& wanted) {
  std::vector<double> ends = {0.0};
  ends.insert(ends.end(), wanted.stops.begin(), wanted.stops.end());
  ends.push_back(1.0);
  return ends;
}

double piecesOf(double length, double size, Rounding rounding) {
  EdgeSize wanted;
  wanted.size = size;
  return pieceCount(length, wanted, rounding);
}

}  // namespace

double pieceCount(double length, const EdgeSize& wanted, Rounding rounding) {
  if (!wanted.stops.empty()) {
    const auto ends = partEnds(wanted);
    double sum = 0;
    for (std::size_t k = 1; k < ends.size(); ++k) {
      sum += piecesOf((ends[k] - ends[k - 1]) * length, wanted.size, rounding);
    }
    return sum;
  }
  const double pieces = isGraded(wanted) ? Measure(length, wanted).total() : length / wanted.size;
  // A length that is a multiple of the size but for rounding must not get one piece more.
  const double whole = rounding == Rounding::at_most ? std::ceil(pieces * (1 - 1e-12))
                                                     : std::round(pieces * (1 + 1e-12));
  return std::max(1.0, std::min(whole, std::floor(wanted.most_pieces)));
}

std::array<double, 2> endPieces(double length, const EdgeSize& wanted, double count,
                                Rounding rounding) {
  if (wanted.stops.empty()) return {length / count, length / count};
  const double first = wanted.stops.front() * length;
  const double last = (1 - wanted.stops.back()) * length;
  return {first / piecesOf(first, wanted.size, rounding),
          last / piecesOf(last, wanted.size, rounding)};
}

std::vector<double> cutFractions(double length, const EdgeSize& wanted, double count,
                                 Rounding rounding) {
  std::vector<double> cuts;
  if (!wanted.stops.empty()) {
    const auto ends = partEnds(wanted);
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const double part = ends[k] - ends[k - 1];
      const double pieces = piecesOf(part * length, wanted.size, rounding);
      if (k > 1) cuts.push_back(ends[k - 1]);
      for (double i = 1; i < pieces; ++i) cuts.push_back(ends[k - 1] + part * (i / pieces));
    }
    return cuts;
  }
  if (!isGraded(wanted)) {
    for (double k = 1; k < count; ++k) cuts.push_back(k / count);
    return cuts;
  }
  const Measure measure(length, wanted);
  for (double k = 1; k < count; ++k) {
    cuts.push_back(measure.inverse(measure.total() * (k / count)) / length);
  }
  return cuts;
}

}  // namespace radiosity
