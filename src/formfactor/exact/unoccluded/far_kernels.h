// Exchange areas of elements that are small against their distance, a row at a time.
//
// With r from the row's centroid to the column's, heights p of the column's centroid above the
// row's plane and q the other way round, the kernel of the exchange area is k = p q / (pi r^4).
// Averaged over both elements up to second moments (M of d d^T, about the centroids), and with the
// products of both elements' first-order terms, for p varies only over the column and q only over
// the row:
//
//   <k> pi s^2 = p q [1 + (12 e/s - 2 m)/s] + 4 (p c_row - q c_column)/s
//                + (4 x - 24 c_row c_column / s) / s,       s = r.r
//   e = r M r (sum of both), m = trace M (sum), c_column = n_row M_column r,
//   c_row = n_column M_row r, x = n_row M_column M_row n_column.
//
// The terms left out are of fourth order in size over distance (of third where an element is no
// parallelogram). The sum R of the second-order terms' magnitudes over p q,
//
//   R = [(12 e/s + 4 m) + 8 (p |c_row| + q |c_column|)/(p q) + 4 |4 x - 24 c_row c_column/s|/(p
//   q)]/s
//
// (weighted so that it bounds errors evenly) takes account of sizes, directions and grazing heights
// alike, and decides. An element's skew is |alpha| + |beta|: 0 for a parallelogram, 1 for a
// triangle. The series serves where its error, kSeriesError R^2 and kSkewError skew R^(3/2), is
// below the tolerance (relative); else the first rule (far_rules.h) with kRuleError R^order below
// it, or for triangles kSkewRuleError R^(order - 1/2), and between the two for little skew; else
// nothing: the pair is near. The constants (error_model.h) bound the errors found on pairs of
// all shapes and placements; exact_far_kernels_test holds every instruction set to the tolerance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "formfactor/exact/unoccluded/far_columns.h"
#include "formfactor/exact/unoccluded/far_rules.h"

namespace radiosity {

/// The largest R for each rule: plain + skew * skew_part.
template <class T>
struct RuleLimits {
  std::array<T, kFarRules> plain, skew_part;
};

/// The limits of all formulas for a tolerance.
struct FarLimits {
  explicit FarLimits(double tolerance);
  FarBounds of(const FlatShape& shape) const;
  template <class T>
  RuleLimits<T> rules() const;

 private:
  double tolerance_;
};

/// A row's element seen from the frame of the columns' facet (coordinates u, v, normal).
template <class T>
struct FarRow {
  FarRow(const FlatShape& shape, const FacetFrame& own, const FacetFrame& columns,
         const FarBounds& bounds);

  T u_high, u_low, v_high, v_low;  ///< centroid
  T height;                        ///< q: of the centroid above the columns' plane
  T slope_u, slope_v;              ///< of the columns' plane above the row's: n_row . u, n_row . v
  std::array<T, 3> p, q;           ///< moment vectors
  T cross_u, cross_v;              ///< M_row n_column
  T moment;
  T area_over_pi;
  T series_limit, skew;

  /// Points of the rules, relative to the centroid.
  struct Points {
    std::array<T, kFarRulePoints> u, v, height2, weight;  ///< weight: times height; 0 if below
  };
  /// The points of a rule, made when first asked for; they begin at rule.begin.
  const Points& points(const FarRule& rule);

 private:
  FlatShape shape_;
  std::array<Vec3, 4> map_;  // mean, U, V, W in the columns' frame
  double exact_height_;
  std::uint64_t made_ = 0;  // bit rule.begin: made
  Points points_;
};

/// Columns [first, first + count), with the heights of their centroids above the row's plane.
/// `heights` and `values` have room for count + kFarPadding.
template <class T>
struct FarBatch {
  const FarColumns<T>* columns;
  std::size_t first;
  std::size_t count;
  const T* heights;
  T* values;
};

/// Marks a near pair in `values`.
inline constexpr double kNearPair = -1;

template <class T>
using FarFunction = std::size_t (*)(FarRow<T>& row, const FarBatch<T>& batch,
                                    const RuleLimits<T>& limits);

/// Writes G of the row with each column, or kNearPair; returns how many are near. All elements in
/// front of each other's planes.
struct FarKernels {
  std::string target;  ///< instruction set, by Highway's name
  FarFunction<float> single_precision;
  FarFunction<double> double_precision;
};

/// The best instruction set of this machine; `simd` false: Highway's scalar target, the same bits.
FarKernels farKernels(bool simd);

}  // namespace radiosity
