#include <bit>

#include "visibility/shadows/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/shadows/kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// One vector for the four corners, or two of half the size.
using Corners = hn::CappedTag<double, 4>;
using Heights = hn::Vec<Corners>;

HWY_INLINE Heights heights(const ShadowPlane& plane, const ShapeCorners& shape, std::size_t k) {
  const Corners d;
  const auto x = hn::Mul(hn::Set(d, plane.x), hn::LoadU(d, shape.x.data() + k));
  const auto y = hn::Mul(hn::Set(d, plane.y), hn::LoadU(d, shape.y.data() + k));
  const auto z = hn::Mul(hn::Set(d, plane.z), hn::LoadU(d, shape.z.data() + k));
  return hn::Sub(hn::Add(hn::Add(x, y), z), hn::Set(d, plane.offset));
}

std::size_t findAbove(const ShadowPlane* planes, std::uint64_t bits, const ShapeCorners& shape,
                      double least, std::uint64_t& below) {
  const Corners d;
  const auto bound = hn::Set(d, least);
  below = 0;
  for (std::uint64_t left = bits; left != 0; left &= left - 1) {
    const auto p = std::size_t(std::countr_zero(left));
    std::size_t above = 0;
    for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
      above += hn::CountTrue(d, hn::Ge(heights(planes[p], shape, k), bound));
    }
    if (above == 4) return p;
    if (above == 0) below |= std::uint64_t(1) << p;
  }
  return kPlaneBits;
}

std::size_t findCrossed(const ShadowPlane* planes, std::size_t count, std::size_t start,
                        const ShapeCorners& shape, double most) {
  const Corners d;
  const auto bound = hn::Set(d, most);
  for (std::size_t n = 0, p = start; n < count; ++n, p = p + 1 < count ? p + 1 : 0) {
    for (std::size_t k = 0; k < 4; k += hn::Lanes(d)) {
      if (!hn::AllFalse(d, hn::Gt(heights(planes[p], shape, k), bound))) return p;
    }
  }
  return count;
}

VisibilityKernels kernels() { return {hwy::TargetName(HWY_TARGET), findAbove, findCrossed}; }

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

VisibilityKernels visibilityKernels(bool simd) {
  return (simd ? HWY_DYNAMIC_DISPATCH(kernels) : HWY_CHOOSE_FALLBACK(kernels))();
}

}  // namespace radiosity
#endif
