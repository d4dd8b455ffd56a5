// How far off a row counted by rays is: from what its replicates differ by, and from what other
// rows teach.
#pragma once

#include <cstddef>

namespace radiosity {

/// How far off a row is.
struct RowAccuracy {
  double norm = 0;      ///< sqrt(sum_j F_ij^2)
  double error = 0;     ///< root mean square expected of sqrt(sum_j (F_ij - true F_ij)^2)
  double foreseen = 0;  ///< the same from the numbers of hits, but for a factor that all rows share
  /// About: of how many independent terms the squared error is the sum, ...
  double terms = 1;
  /// ... and how many its estimate rests on.
  double degrees = 1;
  double known_error = 0;  ///< stated, of the entries that are known; not in `error`
  double backs_norm = 0;   ///< as `norm`, of the black backs that it sees, ...
  double backs_error = 0;  ///< ... and as `error`
  double rays = 0;         ///< its own that count, of both replicates

  /// What sqrt(sum_j (F_ij - true F_ij)^2), backs among the j, is below in 99% of rows: error
  /// squared over its estimate is distributed like F with `terms` degrees of freedom above and
  /// `degrees` below. At least what so many rays may all have missed.
  double figure() const;
};

/// Sums over the entries of a row, of which each replicate has an estimate.
class ReplicateSums {
 public:
  /// `foreseen`: foreseenVariance() of the mean.
  void add(double first, double second, double foreseen) {
    const double half = 0.5 * (first - second);
    product_ += first * second;
    squares_ += half * half;
    foreseen_ += foreseen;
    foreseen_squares_ += foreseen * foreseen;
  }
  RowAccuracy accuracy() const;

 private:
  double product_ = 0;
  double squares_ = 0;
  double foreseen_ = 0;
  double foreseen_squares_ = 0;
};

/// Of a mean form factor that so many hits say, in rays of scrambled nets: the variance `1 -
/// factor` of independent rays, less what nets gain. They leave to chance the cells of the net that
/// the border of what is hit runs through: of n points in four dimensions about n^(3/4).
double foreseenVariance(double factor, double hits);

/// What rows have in common. A row's own two replicates say little of its error where few entries
/// make it: they may agree by chance. So the error is a mean of what they say and of what all rows
/// say, weighted by how well each is known: the credibility of Buehlmann, "Experience rating and
/// credibility", ASTIN Bulletin 4 (1967).
class CommonError {
 public:
  /// Rows as they come from their replicates.
  void add(const RowAccuracy& row);
  /// The row with an error by both, and more degrees of freedom.
  RowAccuracy moderated(const RowAccuracy& row) const;

 private:
  double rows_ = 0;
  double degrees_ = 0;
  double ratios_ = 0;   ///< sum of squared error over foreseen
  double squares_ = 0;  ///< of these ratios, each over what chance makes of one that is 1
};

}  // namespace radiosity
