#include "formfactor/exact/lanes.h"
#include "formfactor/exact/unoccluded/far_kernels.h"
#include "formfactor/exact/unoccluded/far_rules.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formfactor/exact/unoccluded/far_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

#undef RADIOSITY_FAR_NAMESPACE
#undef RADIOSITY_FAR_INLINE
#undef RADIOSITY_FAR_ATTR
#define RADIOSITY_FAR_NAMESPACE radiosity::HWY_NAMESPACE
#define RADIOSITY_FAR_INLINE HWY_INLINE
#define RADIOSITY_FAR_ATTR HWY_ATTR

HWY_BEFORE_NAMESPACE();
#include "formfactor/exact/unoccluded/far_kernels-inl.h"

namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
std::size_t vectorRow(FarRow<T>& row, const FarBatch<T>& batch, const RuleLimits<T>& limits) {
  // At most the padding's width, so that whole vectors never leave an array.
  return farRow<T>(hn::CappedTag<T, kFarPadding>(), row, batch, limits);
}

FarKernels farKernels() {
  return {hwy::TargetName(HWY_TARGET), vectorRow<float>, vectorRow<double>};
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(farKernels);

FarKernels simdFarKernels() { return HWY_DYNAMIC_DISPATCH(farKernels)(); }

}  // namespace radiosity
#endif
