// Exchange areas of elements with nothing between them, in closed form or by product quadrature.
#pragma once

#include <span>

#include "formfactor/exact/elements.h"

namespace radiosity {

/// Pairs by the formula that was used.
struct UnoccludedCounts {
  std::size_t contour = 0;  ///< area to area by contour integrals
  std::size_t lambert = 0;  ///< point to polygon, averaged over points
  std::size_t product = 0;  ///< product Gauss
  std::size_t clipped = 0;  ///< of all: clipped to each other's front half-space first
  UnoccludedCounts& operator+=(const UnoccludedCounts& other);
};

/// Prepares an element set for the kernels below (single precision copies, quadrature points).
class UnoccludedKernel {
 public:
  /// `tolerance`: relative, of every single value; 1e-5 down to 1e-12. `simd` false: scalar twin.
  UnoccludedKernel(const ElementSet& elements, double tolerance, bool simd);

  /// out[(r - rows.first) * stride + (c - columns.first)] = G_rc in ElementSet's scaled units, >=
  /// 0, for all pairs. Rows in one facet, columns in another. Thread-safe.
  void block(ElementRange rows, ElementRange columns, double* out, std::size_t stride,
             UnoccludedCounts& counts) const;
  /// One pair.
  double pair(Index row, Index column) const;
};

}  // namespace radiosity
