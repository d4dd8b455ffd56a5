#include "formfactor/exact/error_figure.h"

#include <algorithm>
#include <cmath>

namespace radiosity {

ErrorSums::Clipped& ErrorSums::Clipped::operator+=(const Clipped& other) {
  squares += other.squares;
  fourths += other.fourths;
  areas += other.areas;
  return *this;
}

double ErrorSums::Clipped::figure(double surplus) const {
  return squares + std::sqrt(fourths) + surplus * areas;
}

ErrorSums& ErrorSums::operator+=(const ErrorSums& other) {
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    squares_[i] += other.squares_[i];
    clipped_[i] += other.clipped_[i];
    bare_[i] += other.bare_[i];
  }
  difference_ += other.difference_;
  stated_ += other.stated_;
  rechecked_ += other.rechecked_;
  return *this;
}

void ErrorSums::addAndScale(std::size_t row, std::span<double> exchange, double inverse_area) {
  // Two passes of independent elements, and one sum in four lanes: the compiler may vectorise all
  // of it without reordering an addition.
  double* squares = squares_.data() + row;
  const std::size_t n = exchange.size();
  double lane[4] = {};
  std::size_t m = 0;
  for (; m + 4 <= n; m += 4) {
    for (std::size_t l = 0; l < 4; ++l) {
      const double square = exchange[m + l] * exchange[m + l];
      squares[m + l] += square;
      lane[l] += square;
      exchange[m + l] *= inverse_area;
    }
  }
  for (; m < n; ++m) {
    const double square = exchange[m] * exchange[m];
    squares[m] += square;
    lane[0] += square;
    exchange[m] *= inverse_area;
  }
  squares[0] += (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

double ErrorSums::weightedSquares(std::span<const double> area) const {
  double sum = 0;
  for (std::size_t i = 0; i < area.size(); ++i) sum += squares_[i] / area[i];
  return sum;
}

double ErrorSums::recheckRatio() const {
  return stated_ > 0 ? std::sqrt(difference_ / stated_) : 0.0;
}

double ErrorSums::figures(std::span<const double> area, double closed_form,
                          std::span<double> figure) const {
  // Of a pair, squared and over the product of its areas.
  const double surplus =
      rechecked_ > 0
          ? kSurplusShare * std::max(0.0, difference_ - kUsual * stated_) / double(rechecked_)
          : 0.0;
  const double closed = kClosedFormShare * closed_form;
  double errors = 0;
  for (std::size_t i = 0; i < figure.size(); ++i) {
    const double closed_forms = closed * closed * squares_[i];
    Clipped row = clipped_[i];
    errors += (closed_forms + row.figure(surplus)) / area[i];
    row += bare_[i];
    figure[i] = std::sqrt(closed_forms + row.figure(surplus)) / area[i];
  }
  const double squares = weightedSquares(area);
  return squares > 0 ? std::sqrt(errors / squares) : 0.0;
}

}  // namespace radiosity
