#include <bit>

#include "formfactor/exact/visibility/kernels.h"

namespace radiosity {
namespace {

double height(const ShadowPlane& plane, const ShapeCorners& shape, std::size_t k) {
  return plane.x * shape.x[k] + plane.y * shape.y[k] + plane.z * shape.z[k] - plane.offset;
}

std::size_t findAbove(const ShadowPlane* planes, std::uint64_t bits, const ShapeCorners& shape,
                      double least, std::uint64_t& below) {
  below = 0;
  for (std::uint64_t left = bits; left != 0; left &= left - 1) {
    const auto p = std::size_t(std::countr_zero(left));
    unsigned above = 0;
    for (std::size_t k = 0; k < 4; ++k) above += unsigned(height(planes[p], shape, k) >= least);
    if (above == 4) return p;
    if (above == 0) below |= std::uint64_t(1) << p;
  }
  return kPlaneBits;
}

std::size_t findCrossed(const ShadowPlane* planes, std::size_t count, std::size_t start,
                        const ShapeCorners& shape, double most) {
  for (std::size_t n = 0, p = start; n < count; ++n, p = p + 1 < count ? p + 1 : 0) {
    for (std::size_t k = 0; k < 4; ++k) {
      if (height(planes[p], shape, k) > most) return p;
    }
  }
  return count;
}

}  // namespace

VisibilityKernels scalarVisibilityKernels() { return {"scalar", findAbove, findCrossed}; }

}  // namespace radiosity
