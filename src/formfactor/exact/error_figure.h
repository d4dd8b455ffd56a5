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
/// clipped against occluders it is what its embedded rules say, and what they overlook. Of that (a
/// shadow's edge between all points of both rules) they know nothing. So a random subset is
/// evaluated again with points on the other element, where shadows lie differently. Where the two
/// ends differ by more than both state, a part of the surplus, in squares and as a mean over all
/// that were looked at, is what every clipped pair's error may be larger. In the closed Cornell box
/// with 308 and 985 patches and in two rooms with 572, at tolerances from 1e-2 to 1e-5, at most 1
/// of 100 rows is beyond its figure, whose median is 5 to 11 times the median error
/// (truth_exact_test).
class ErrorSums {
 public:
  ErrorSums() = default;
  explicit ErrorSums(std::size_t rows)
      : squares_(rows, 0.0), errors_(rows, 0.0), clipped_(rows, 0.0) {}

  ErrorSums& operator+=(const ErrorSums& other);

  /// Adds the upper row of `row`: exchange[m] with row + m. Scales it to form factors.
  void addAndScale(std::size_t row, std::span<double> exchange, double inverse_area);
  /// `error`: absolute, of the exchange of one clipped pair. `areas`: the product of theirs.
  void addPartial(std::size_t row, std::size_t column, double error, double areas) {
    const double square = error * error;
    errors_[row] += square;
    errors_[column] += square;
    clipped_[row] += areas;
    clipped_[column] += areas;
  }
  /// The same pair from both ends: how far they differ and the error each states.
  void addRecheck(double difference, double stated, double other_stated, double areas) {
    difference_ += difference * difference / areas;
    stated_ += (stated * stated + other_stated * other_stated) / areas;
    ++rechecked_;
  }

  /// sum A F^2 over all pairs, both ways. `area`: of the rows.
  double weightedSquares(std::span<const double> area) const;
  std::size_t rechecked() const { return rechecked_; }
  /// rms difference of the two ends over what they state; 0 where nothing was compared.
  double recheckRatio() const;

  static constexpr double kClosedFormShare = 0.1;  ///< see above
  /// Of the surplus, in squares: the other end is nearer to what blocks and the worse one to look
  /// from, so most of the difference is its own.
  static constexpr double kSurplusShare = 0.125;

  /// figure[row], absolute, of F. `area`: of the rows; `closed_form`: published relative accuracy
  /// of closed forms. Returns the matrix figure: sqrt(sum A err^2 / sum A F^2), with the same
  /// margin.
  double figures(std::span<const double> area, double closed_form, std::span<double> figure) const;

 private:
  std::vector<double> squares_;  ///< sum_j G_ij^2
  std::vector<double> errors_;   ///< sum_j err_ij^2 over clipped pairs, as stated
  std::vector<double> clipped_;  ///< sum_j A_i A_j over clipped pairs
  double difference_ = 0;
  double stated_ = 0;
  std::size_t rechecked_ = 0;
};

}  // namespace radiosity
