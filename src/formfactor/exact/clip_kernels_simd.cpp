#include <limits>

#include "formfactor/exact/clip_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formfactor/exact/clip_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

#undef CLIP_INLINE
#define CLIP_INLINE HWY_INLINE

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
struct Ops {
  // Not more lanes than arrays are filled up to, and the same number for both precisions' words.
  using D = hn::CappedTag<T, kLaneAlignment>;
  using Words = hn::RebindToUnsigned<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using U = hn::Vec<Words>;
  static HWY_INLINE std::size_t lanes() { return hn::Lanes(D()); }
  static HWY_INLINE V load(const T* p) { return hn::Load(D(), p); }
  static HWY_INLINE void store(V v, T* p) { hn::Store(v, D(), p); }
  static HWY_INLINE V set(T v) { return hn::Set(D(), v); }
  static HWY_INLINE V add(V a, V b) { return hn::Add(a, b); }
  static HWY_INLINE V sub(V a, V b) { return hn::Sub(a, b); }
  static HWY_INLINE V mul(V a, V b) { return hn::Mul(a, b); }
  static HWY_INLINE V div(V a, V b) { return hn::Div(a, b); }
  static HWY_INLINE V sqrt(V a) { return hn::Sqrt(a); }
  static HWY_INLINE V abs(V a) { return hn::Abs(a); }
  static HWY_INLINE V min(V a, V b) { return hn::Min(a, b); }
  static HWY_INLINE V max(V a, V b) { return hn::Max(a, b); }
  static HWY_INLINE M greater(V a, V b) { return hn::Gt(a, b); }
  static HWY_INLINE M greaterEqual(V a, V b) { return hn::Ge(a, b); }
  static HWY_INLINE M both(M a, M b) { return hn::And(a, b); }
  static HWY_INLINE M either(M a, M b) { return hn::Or(a, b); }
  /// b, but where a.
  static HWY_INLINE M without(M a, M b) { return hn::AndNot(a, b); }
  static HWY_INLINE bool all(M m) { return hn::AllTrue(D(), m); }
  static HWY_INLINE bool none(M m) { return hn::AllFalse(D(), m); }
  static HWY_INLINE V choose(M m, V yes, V no) { return hn::IfThenElse(m, yes, no); }
  static HWY_INLINE U noLabel() { return hn::Zero(Words()); }
  static HWY_INLINE U addLabel(U word, M m, std::uint32_t label) {
    const auto value = hn::Set(Words(), label);
    return hn::Add(word, hn::IfThenElseZero(hn::RebindMask(Words(), m), value));
  }
  static HWY_INLINE void storeLabels(U word, ShapeWord<T>* p) { hn::Store(word, Words(), p); }
};

#include "formfactor/exact/clip_kernels.inc"

ClipKernelSet clipKernels() {
  return {hwy::TargetName(HWY_TARGET),
          {wholeLanes<float>, hiddenLanes<float>, commonLanes<float>},
          {wholeLanes<double>, hiddenLanes<double>, commonLanes<double>}};
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(clipKernels);

ClipKernelSet simdClipKernels() { return HWY_DYNAMIC_DISPATCH(clipKernels)(); }

}  // namespace radiosity
#endif
