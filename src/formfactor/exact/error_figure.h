// How far the rows of an exact form-factor matrix may be from the truth.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace radiosity {

/// What is known of the errors of some pairs, all in exchange areas G of ElementSet's units. Sums
/// of disjoint sets of pairs add up.
///
/// A row's error figure is sqrt(sum_j err_ij^2): errors of different pairs have different causes
/// and signs, and add up in squares. For a pair in closed form err is a tenth of the kernel's
/// published accuracy: that is a bound, which the worst pair comes near, not a row. For a pair
/// clipped against occluders it is what its embedded rules say. That would be worth little where
/// they overlook what both of their sets of points overlook (a shadow's edge between them). So a
/// random subset is evaluated again with points on the other element, where shadows lie
/// differently; if the two ends differ by more than they say, rms, the figures of all clipped pairs
/// are multiplied by that ratio. A margin covers the rows in which such a pair is: with it 99 of
/// 100 rows of the closed Cornell box (985 patches) and 60 of 60 of two rooms (572) are within
/// their figures, whose median is 7 times the median error in both (truth_exact_test).
class ErrorSums {
 public:
  ErrorSums() = default;
  explicit ErrorSums(std::size_t rows) : squares_(rows, 0.0), errors_(rows, 0.0) {}

  ErrorSums& operator+=(const ErrorSums& other);

  /// Adds the upper row of `row`: exchange[m] with row + m. Scales it to form factors.
  void addAndScale(std::size_t row, std::span<double> exchange, double inverse_area);
  /// `error`: absolute, of the exchange of one clipped pair.
  void addPartial(std::size_t row, std::size_t column, double error) {
    const double square = error * error;
    errors_[row] += square;
    errors_[column] += square;
  }
  /// The same pair from both ends: how far they differ and the error each states; `weight` makes
  /// of G^2 what the two rows' F^2 is.
  void addRecheck(double difference, double stated, double other_stated, double weight) {
    difference_ += weight * difference * difference;
    stated_ += weight * (stated * stated + other_stated * other_stated);
    ++rechecked_;
  }

  std::size_t rechecked() const { return rechecked_; }
  /// rms difference of the two ends over what they state; 0 where nothing was compared.
  double recheckRatio() const;

  static constexpr double kMargin = 2.5;  ///< of clipped pairs
  static constexpr double kClosedFormShare = 0.1;

  /// figure[row], absolute, of F. `area`: of the rows; `closed_form`: published relative accuracy
  /// of closed forms. Returns the matrix figure: sqrt(sum A err^2 / sum A F^2), with the same
  /// margin.
  double figures(std::span<const double> area, double closed_form, std::span<double> figure) const;

 private:
  std::vector<double> squares_;  ///< sum_j G_ij^2
  std::vector<double> errors_;   ///< sum_j err_ij^2 over clipped pairs
  double difference_ = 0;
  double stated_ = 0;
  std::size_t rechecked_ = 0;
};

}  // namespace radiosity
