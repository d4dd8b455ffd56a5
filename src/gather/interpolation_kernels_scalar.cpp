#include "gather/interpolation_kernels.h"

namespace radiosity {
namespace {

template <std::size_t kCorners>
void add(const FacetRow& facet, const PixelRow& pixels, LaneSums* sums) {
  for (int m = 0; m < pixels.count; ++m) {
    const double centre = pixels.first_centre + m;
    std::array<double, kCorners> a;
    for (std::size_t k = 0; k < kCorners; ++k) {
      const double inside = facet.slope[k] * centre + facet.base[k];
      a[k] = inside > 0 ? inside : 0;
    }
    std::array<double, kCorners> w;  // of a quadrilateral without C_k, which `rise` has
    double total = 0;
    for (std::size_t k = 0; k < kCorners; ++k) {
      if constexpr (kCorners == 4) {
        w[k] = a[(k + 1) % 4] * a[(k + 2) % 4];
        total += facet.area[k] * w[k];
      } else {
        w[k] = a[(k + 1) % 3];
        total += w[k];
      }
    }
    const double share = total > 0 ? (pixels.weights[m + 1] - pixels.weights[m]) / total : 0;
    for (std::size_t b = 0; b < facet.rise.size(); ++b) {
      double above = facet.rise[b][1] * w[1];
      for (std::size_t k = 2; k < kCorners; ++k) above += facet.rise[b][k] * w[k];
      sums[b].sum[std::size_t(m) % kLanes] += share * above;
    }
  }
}

}  // namespace

InterpolationKernels scalarInterpolation() { return {"scalar", add<3>, add<4>}; }

}  // namespace radiosity
