// Exchange areas of elements with nothing between them, in closed form or by product quadrature.
#pragma once

#include <memory>

#include "visibility/elements/elements.h"

namespace radiosity {

/// Pairs by the formula that was used.
struct UnoccludedCounts {
  std::size_t contour = 0;  ///< area to area by contour integrals
  std::size_t lambert = 0;  ///< point to polygon, averaged over points
  std::size_t product = 0;  ///< series or product Gauss, far away
  std::size_t clipped = 0;  ///< of all: clipped to each other's front half-space first
  UnoccludedCounts& operator+=(const UnoccludedCounts& other);
};

/// Exchange areas of the elements of a set. Each value takes the first that is sharp enough of:
/// second-order series and product Gauss (far_kernels.h), Lambert's formula over Gauss points and
/// contour integrals (near_exchange.h). Elements that cross each other's plane by more than
/// coincidence are clipped first; parts within it exchange nothing.
///
/// Error: below `tolerance` relative (single precision adds up to 1e-6), by choice of the formula:
///
///     formula                     where, at 1e-5, for facing squares of half-width h
///     second-order series         farther than about 50 h
///     product rules, 16 to 625    from there to about 4 h
///     Lambert over Gauss points   from there to touching, or thinner elements
///     contour integrals           touching or nearly so
///
/// exact_far_kernels_test holds every instruction set to it, exact_unoccluded_test and
/// exact_closed_forms_test the whole. Contours lose about 1e-16 times the square of the pair's
/// extent to cancellation. The values do not depend on the instruction set, nor on how pairs are
/// put into blocks.
class UnoccludedKernel {
 public:
  /// Keeps `elements` by reference. `tolerance`: relative, of every single value; 1e-12 to 1e-2;
  /// below 3e-6 in double precision throughout. `simd` false: the scalar target, the same bits.
  UnoccludedKernel(const ElementSet& elements, double tolerance, bool simd);
  ~UnoccludedKernel();

  /// out[(r - rows.first) * stride + (c - columns.first)] = G_rc in ElementSet's scaled units, >=
  /// 0, for all pairs. Rows in one facet, columns in another. Thread-safe.
  void block(ElementRange rows, ElementRange columns, double* out, std::size_t stride,
             UnoccludedCounts& counts) const;
  /// One pair, elements of different facets.
  double pair(Index row, Index column) const;

 private:
  class Implementation;
  template <class T>
  class Typed;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace radiosity
