// The error of a row counted by rays: from the difference of its replicates, and from other rows.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "formfactor/rays/ray_model.h"

namespace radiosity {

/// The error of a row.
struct RowAccuracy {
  double norm = 0;      ///< sqrt(sum_j F_ij^2)
  double error = 0;     ///< root mean square expected of sqrt(sum_j (F_ij - true F_ij)^2)
  double foreseen = 0;  ///< the same from the numbers of hits, but for a factor that all rows share
  /// The number of independent terms that sum up to the squared error, about.
  double terms = 1;
  /// The number of terms that its estimate rests on, about.
  double degrees = 1;
  double known_error = 0;  ///< stated, of the entries that are known; not in `error`
  double backs_norm = 0;   ///< as `norm`, of the black backs that it sees, ...
  double backs_error = 0;  ///< ... and as `error`
  /// The share of its area where origins of rays are not told apart from what stands beside them:
  /// an error of as much, not in `error`.
  double unresolved = 0;
  double rays = 0;  ///< its own that count, of both replicates
  double hits = 0;  ///< of them, those that fronts are to take by the merged row

  /// A bound that holds in 99% of rows on sqrt(sum_j (F_ij - true F_ij)^2), backs among the j:
  /// error squared over its estimate is distributed like F with `terms` degrees of freedom above
  /// and `degrees` below. It is at least the share that all rays may have missed, and what is
  /// unresolved.
  double figure() const;

  /// True if it has seen next to nothing: neither the difference of its replicates nor what is
  /// foreseen from so few hits says how far it is off.
  bool isUnknown() const;
  /// `error`, or if it is unknown at least the share of its view that 95% of such rows may have
  /// more than was seen: 3 / rays without a hit.
  double expectedError() const;
};

/// The error over the norm; infinite if there is an error of nothing.
inline double relativeTo(double norm, double error) {
  if (norm > 0) return error / norm;
  return error > 0 ? std::numeric_limits<double>::infinity() : 0.0;
}

/// Sums over the entries of a row; each replicate has an estimate of each entry.
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

/// The variance of a number of hits by independent rays, of which `share` hit.
double hitsVariance(double share, double hits);

/// The same of a pair's hits from both ends: `hits` of its own and of the other one, `area`
/// likewise, `factor` from its own to the other one.
double pairHitsVariance(double factor, const std::array<double, 2>& hits,
                        const std::array<double, 2>& area);

/// The variance of a mean form factor known from `hits` hits by rays of scrambled nets:
/// `of_hits`, that of independent rays (hitsVariance()), less the gain of nets. They leave to
/// chance the cells of the net that a target's border runs through: of n points in four dimensions
/// about n^(3/4). One ray is left to chance in any case: of n that all hit, the next may miss.
double foreseenVariance(double factor, double hits, double of_hits);

/// The error that rows have in common. A row's own two replicates say little of its error if few
/// entries make it: they may agree by chance. So the error is a mean of the row's own estimate and
/// that of all rows, weighted by how well each is known: the credibility of Buehlmann, "Experience
/// rating and credibility", ASTIN Bulletin 4 (1967). It begins with kUsualRows rows that are as far
/// off as foreseen: two plates are two rows, whose replicates may agree in the only pair there is.
class CommonError {
 public:
  /// Adds a row with the error that its replicates show.
  void add(const RowAccuracy& row);
  /// The row with its error by both estimates, and more degrees of freedom.
  RowAccuracy moderated(const RowAccuracy& row) const;

 private:
  double rows_ = kUsualRows;
  double degrees_ = kUsualRows;
  double ratios_ = kUsualRows;  ///< sum of squared error over foreseen
  /// Sum of their squares, each over 1 + 2 / degrees, its mean by chance.
  double squares_ = kUsualRows;
};

}  // namespace radiosity
