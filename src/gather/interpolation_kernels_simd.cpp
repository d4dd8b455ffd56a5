#include "gather/interpolation_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "gather/interpolation_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// Included after foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, kLanes>;
using Vector = hn::Vec<Doubles>;

constexpr int kWidth = int(hn::MaxLanes(Doubles()));
constexpr std::size_t kVectors = kLanes / std::size_t(kWidth);

/// Weights of the pixels from `first` on, up to a vector of them; 0 beyond the run.
HWY_INLINE Vector worth(const PixelRow& pixels, int first) {
  const Doubles d;
  const double* at = pixels.weights + first;
  if (first + kWidth > pixels.readable) {
    double alone[kWidth] = {};
    for (int m = 0; first + m < pixels.count; ++m) alone[m] = at[m + 1] - at[m];
    return hn::LoadU(d, alone);
  }
  const Vector all = hn::Sub(hn::LoadU(d, at + 1), hn::LoadU(d, at));
  const int left = pixels.count - first;
  return left >= kWidth ? all : hn::IfThenElseZero(hn::FirstN(d, std::size_t(left)), all);
}

/// A facet and some of its bands, in registers for a whole run.
template <std::size_t kCorners, std::size_t kBands>
struct Broadcast {
  Vector slope[kCorners];
  Vector base[kCorners];
  Vector area[kCorners];
  Vector rise[kBands][kCorners];

  HWY_INLINE Broadcast(const FacetRow& facet, std::size_t first_band) {
    const Doubles d;
    for (std::size_t k = 0; k < kCorners; ++k) {
      slope[k] = hn::Set(d, facet.slope[k]);
      base[k] = hn::Set(d, facet.base[k]);
      area[k] = hn::Set(d, facet.area[k]);
      for (std::size_t b = 0; b < kBands; ++b) {
        rise[b][k] = hn::Set(d, facet.rise[first_band + b][k]);
      }
    }
  }

  /// Computes the corners' weights without C_k, and returns the sum of the weights with C_k.
  HWY_INLINE Vector weigh(Vector centre, Vector* w) const {
    Vector a[kCorners];
    for (std::size_t k = 0; k < kCorners; ++k) {
      const Vector inside = hn::Add(hn::Mul(slope[k], centre), base[k]);
      a[k] = hn::Max(inside, hn::Zero(Doubles()));
    }
    Vector total = hn::Zero(Doubles());
    for (std::size_t k = 0; k < kCorners; ++k) {
      if constexpr (kCorners == 4) {
        w[k] = hn::Mul(a[(k + 1) % 4], a[(k + 2) % 4]);
        total = hn::Add(total, hn::Mul(area[k], w[k]));
      } else {
        w[k] = a[(k + 1) % 3];
        total = hn::Add(total, w[k]);
      }
    }
    return total;
  }
};

template <std::size_t kCorners, std::size_t kBands>
HWY_INLINE void addBands(const FacetRow& facet, std::size_t first_band, const PixelRow& pixels,
                         LaneSums* sums) {
  const Doubles d;
  const Broadcast<kCorners, kBands> all(facet, first_band);
  const Vector zero = hn::Zero(d);
  Vector centre = hn::Add(hn::Set(d, pixels.first_centre), hn::Iota(d, 0));
  const Vector step = hn::Set(d, double(kWidth));
  std::size_t v = 0;
  for (int first = 0; first < pixels.count; first += kWidth) {
    Vector w[kCorners];
    const Vector total = all.weigh(centre, w);
    const Vector share =
        hn::IfThenElseZero(hn::Gt(total, zero), hn::Div(worth(pixels, first), total));
    for (std::size_t b = 0; b < kBands; ++b) {
      Vector above = hn::Mul(all.rise[b][1], w[1]);
      for (std::size_t k = 2; k < kCorners; ++k) {
        above = hn::Add(above, hn::Mul(all.rise[b][k], w[k]));
      }
      double* sum = sums[first_band + b].sum.data() + v * std::size_t(kWidth);
      hn::Store(hn::Add(hn::Load(d, sum), hn::Mul(share, above)), d, sum);
    }
    centre = hn::Add(centre, step);
    v = (v + 1) % kVectors;
  }
}

/// Handles three bands at a time, so that colours take one turn.
template <std::size_t kCorners>
void add(const FacetRow& facet, const PixelRow& pixels, LaneSums* sums) {
  const std::size_t bands = facet.rise.size();
  std::size_t b = 0;
  for (; b + 3 <= bands; b += 3) addBands<kCorners, 3>(facet, b, pixels, sums);
  if (bands - b == 2) addBands<kCorners, 2>(facet, b, pixels, sums);
  if (bands - b == 1) addBands<kCorners, 1>(facet, b, pixels, sums);
}

InterpolationKernels kernels() { return {hwy::TargetName(HWY_TARGET), add<3>, add<4>}; }

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

InterpolationKernels interpolationKernels(bool simd) {
  return (simd ? HWY_DYNAMIC_DISPATCH(kernels) : HWY_CHOOSE_FALLBACK(kernels))();
}

}  // namespace radiosity
#endif
