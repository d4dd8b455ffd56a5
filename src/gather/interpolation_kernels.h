// The inner loop of interpolation: one facet along one run of pixels. One kernel per instruction
// set, Highway's scalar target among them; all give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace radiosity {

/// Running sums a band: pixel m of a run goes to sum m modulo kLanes, and they are added up in a
/// fixed order, so that it does not matter how many an instruction set holds in a vector.
inline constexpr std::size_t kLanes = 8;

/// A facet as one row of pixels sees it. A_k at a pixel whose centre is x is
/// max(slope_k x + base_k, 0): a pixel that lies outside by rounding is moved onto the outline.
struct FacetRow {
  std::array<double, 4> slope{};
  std::array<double, 4> base{};
  std::array<double, 4> area{};  ///< C_k; of a triangle, unused
  /// [band][corner]: what corner k > 0 is above corner 0; of a quadrilateral times C_k. Kernels do
  /// not read [band][0].
  std::span<const std::array<double, 4>> rise;
};

/// Pixels of one row, the first with its centre at `first_centre`, pixel m worth
/// weights[m + 1] - weights[m].
struct PixelRow {
  const double* weights;
  double first_centre;
  int count;
  int readable;  ///< `count` or more: so many pixels have weights
};

/// One band's W/m^2 above corner 0's value.
struct alignas(64) LaneSums {
  std::array<double, kLanes> sum{};
};

struct InterpolationKernels {
  std::string target;  ///< instruction set, by Highway's name
  /// sums += weight * (value interpolated - value of corner 0) over the pixels. Pixels where the
  /// facet is seen as a point take corner 0's value. `sums`: one a band of the facet's rise.
  void (*addTriangle)(const FacetRow& facet, const PixelRow& pixels, LaneSums* sums);
  void (*addQuad)(const FacetRow& facet, const PixelRow& pixels, LaneSums* sums);
};

/// The best instruction set of this machine; `simd` false: Highway's scalar target, the same bits.
InterpolationKernels interpolationKernels(bool simd);

}  // namespace radiosity
