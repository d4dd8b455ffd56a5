// The inner loop of interpolation: one facet along one run of pixels. One kernel per instruction
// set, Highway's scalar target among them; all give the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace radiosity {

/// The running sums for each band. Pixel m of a run goes to sum m modulo kLanes, and the sums are
/// added up in a fixed order, so that the vector length does not matter.
inline constexpr std::size_t kLanes = 8;

/// A facet along one row of pixels. At a pixel with centre x, A_k = max(slope_k x + base_k, 0): a
/// pixel that lies outside by rounding is moved onto the outline.
struct FacetRow {
  std::array<double, 4> slope{};
  std::array<double, 4> base{};
  std::array<double, 4> area{};  ///< C_k; of a triangle, unused
  /// [band][corner]: the value of corner k > 0 minus that of corner 0; for a quadrilateral, times
  /// C_k. Kernels do not read [band][0].
  std::span<const std::array<double, 4>> rise;
};

/// Pixels of one row, the first with its centre at `first_centre`, pixel m worth
/// weights[m + 1] - weights[m].
struct PixelRow {
  const double* weights;
  double first_centre;
  int count;
  int readable;  ///< the number of pixels that have weights, `count` or more
};

/// The irradiance of one band, W/m^2, less the part of corner 0's value.
struct alignas(64) LaneSums {
  std::array<double, kLanes> sum{};
};

struct InterpolationKernels {
  std::string target;  ///< instruction set, by Highway's name
  /// sums += weight * (interpolated value - value of corner 0) over the pixels. A pixel that sees
  /// the facet as a point takes corner 0's value. `sums`: one for each band of the facet's rise.
  void (*addTriangle)(const FacetRow& facet, const PixelRow& pixels, LaneSums* sums);
  void (*addQuad)(const FacetRow& facet, const PixelRow& pixels, LaneSums* sums);
};

/// The kernels for the best instruction set of this machine. `simd` false: Highway's scalar target,
/// with the same bits.
InterpolationKernels interpolationKernels(bool simd);

}  // namespace radiosity
