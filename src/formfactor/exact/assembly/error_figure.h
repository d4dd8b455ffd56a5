// Error figures: how far the rows of an exact form-factor matrix may be from the truth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/byte_stream.h"

namespace radiosity {

/// Sums of the errors of some pairs, all in exchange areas G of ElementSet's units. Sums of
/// disjoint sets of pairs add up.
///
/// Errors of a row's pairs have different causes and signs, and add up in squares. For a pair in
/// closed form err is kRowClosedForms (error_model.h) of the kernel's published accuracy: that is a
/// bound, which the worst pair comes near, not a row (the box at 1e-5 leaves no more). For a pair
/// clipped against occluders it is the estimate of its embedded rules, with their margin. The
/// square of its true error scatters about that. The scatter of the sum over a row's occluded pairs
/// goes with sqrt(sum_j err_ij^4): it is large where a few pairs carry the row and small where many
/// do. A row's error figure is
///
///     sqrt(sum_j err_ij^2 + sqrt(sum_occluded j err_ij^4)).
///
/// Occluded pairs with black backs count in the row's figure as well, though not in the matrix's:
/// a row's account of the sky is only as good as its account of them.
///
/// The rules' margin is fitted to some scenes. In others, of thin bodies or of many pairs that are
/// alike, it is not enough. So a random subset of the occluded pairs is evaluated again to a
/// fraction of the tolerance. The difference is taken for their error, rows are drawn at random
/// from these pairs (the bootstrap of Efron 1979), and where the error of the worst hundredth of
/// those rows, times kRowAlike, exceeds its figure, the figures of all rows are raised.
///
/// A pair is drawn as often as it weighs in its two rows, by its share of the sum of their
/// err_ij^2, and counts by its error over the one stated: so a row of a small patch has as much of
/// a say as one of a large patch, whose exchange areas are a thousand times as large. A drawn row
/// has (sum err_ij^2)^2 / sum err_ij^4 pairs of equal weight, of a row i drawn for each: its stated
/// error scatters like that row's. (In a cube in a cube, 204 patches, at 1e-4, errors of rows
/// reach 1.8 times those of the drawn rows.)
///
/// Measured rows and exceptions: src/formfactor/README.md, "Error figures"; truth_exact_test.
class ErrorSums {
 public:
  ErrorSums() = default;
  explicit ErrorSums(std::size_t rows) : squares_(rows, 0.0), occluded_(rows), black_backs_(rows) {}

  ErrorSums& operator+=(const ErrorSums& other);

  /// Adds the upper row of `row`: exchange[m] is with row + m. Scales it to form factors.
  void addAndScale(std::size_t row, std::span<double> exchange, double inverse_area);
  /// Adds an occluded pair. `error`: absolute, of its exchange.
  void addOccluded(std::size_t row, std::size_t column, double error) {
    occluded_[row].add(error);
    occluded_[column].add(error);
  }
  /// The same of a row and a black back.
  void addBlackBack(std::size_t row, double error) { black_backs_[row].add(error); }
  /// Adds an occluded pair of two rows, evaluated to a stricter tolerance: the difference, and the
  /// error that was stated of it.
  void addRecheck(std::size_t row, std::size_t column, double difference, double stated) {
    rechecks_.push_back({row, column, difference, stated});
  }

  /// Writes all of it, where only rows from `first` on have any sums, and reads it back. take()
  /// returns false, with nothing taken, if the bytes are of another number of rows.
  void put(std::size_t first, ByteWriter& bytes) const;
  bool take(std::size_t first, ByteReader& bytes);

  std::size_t rechecked() const { return rechecks_.size(); }
  /// The error over the figure that one in a hundred rows exceeds, of rows drawn from the rechecked
  /// pairs; 0 if there are none.
  double recheckRatio() const;

  /// What all errors of occluded pairs are to be raised by, 1 or more.
  double raise() const;

  /// figure[row], absolute, of F. `area`: of the rows; `closed_form`: published relative accuracy
  /// of closed forms. Returns the matrix figure: sqrt(sum A err^2 / sum A F^2), with the same
  /// margin.
  double figures(std::span<const double> area, double closed_form, std::span<double> figure) const;

 private:
  std::vector<std::uint32_t> recheckedByWeight() const;
  /// sum A F^2 over all pairs, both ways. `area`: of the rows.
  double weightedSquares(std::span<const double> area) const;
  struct Recheck {
    std::size_t row, column;
    double difference;
    double stated;
  };
  /// Sums over a row's occluded pairs.
  struct PairErrors {
    void add(double error) {
      const double square = error * error;
      squares += square;
      fourths += square * square;
    }
    PairErrors& operator+=(const PairErrors& other);
    /// The square of the error, of exchange.
    double figure() const;

    double squares = 0;  ///< err_ij^2, as stated
    double fourths = 0;  ///< err_ij^4
  };

  std::vector<double> squares_;          ///< sum_j G_ij^2
  std::vector<PairErrors> occluded_;     ///< pairs of patches
  std::vector<PairErrors> black_backs_;  ///< pairs of a patch and a black back
  std::vector<Recheck> rechecks_;
};

}  // namespace radiosity
