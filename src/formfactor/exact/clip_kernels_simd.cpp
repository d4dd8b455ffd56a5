#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

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
  using Indices = hn::RebindToSigned<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using U = hn::Vec<Words>;
  using I = hn::Vec<Indices>;
  static HWY_INLINE std::size_t lanes() { return hn::Lanes(D()); }
  static HWY_INLINE V load(const T* p) { return hn::Load(D(), p); }
  static HWY_INLINE void store(V v, T* p) { hn::Store(v, D(), p); }
  /// Rounded.
  static HWY_INLINE void storeAs(V v, T* p) { hn::Store(v, D(), p); }
  static HWY_INLINE void storeAs(V v, float* p)
    requires std::is_same_v<T, double>
  {
    const hn::Rebind<float, D> narrow;
    hn::Store(hn::DemoteTo(narrow, v), narrow, p);
  }
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
  static HWY_INLINE M equal(V a, V b) { return hn::Eq(a, b); }
  static HWY_INLINE M notEqual(V a, V b) { return hn::Ne(a, b); }
  static HWY_INLINE M both(M a, M b) { return hn::And(a, b); }
  static HWY_INLINE M either(M a, M b) { return hn::Or(a, b); }
  /// b, but where a.
  static HWY_INLINE M without(M a, M b) { return hn::AndNot(a, b); }
  static HWY_INLINE bool all(M m) { return hn::AllTrue(D(), m); }
  static HWY_INLINE bool none(M m) { return hn::AllFalse(D(), m); }
  /// Lane k's as bit k.
  static HWY_INLINE std::uint32_t bits(M m) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), m, bytes);
    return bytes[0] | std::uint32_t(bytes[1]) << 8;
  }
  static HWY_INLINE V choose(M m, V yes, V no) { return hn::IfThenElse(m, yes, no); }
  static HWY_INLINE U noLabel() { return hn::Zero(Words()); }
  static HWY_INLINE U setWord(std::uint32_t word) { return hn::Set(Words(), word); }
  static HWY_INLINE U addWord(U word, M m, U other) {
    return hn::Add(word, hn::IfThenElseZero(hn::RebindMask(Words(), m), other));
  }
  static HWY_INLINE void storeWord(U word, ShapeWord<T>* p) { hn::Store(word, Words(), p); }
  static HWY_INLINE I loadIndex(const LaneIndex<T>* p) { return hn::Load(Indices(), p); }
  static HWY_INLINE V gather(const T* from, I index) { return hn::GatherIndex(D(), from, index); }
  static HWY_INLINE U gatherWord(const ShapeWord<T>* from, I index) {
    return hn::GatherIndex(Words(), from, index);
  }
  static HWY_INLINE I after(I first, std::size_t k) {
    return hn::Add(first, hn::Set(Indices(), LaneIndex<T>(k)));
  }
  /// The k-th plane of a cone, or one that does nothing.
  static HWY_INLINE I planeOf(I first, I count, std::size_t k) {
    const I number = hn::Set(Indices(), LaneIndex<T>(k));
    static_assert(ConePlanes<T>::kAllInside == 0);
    return hn::IfThenElseZero(hn::Lt(number, count), hn::Add(first, number));
  }
};

#include "formfactor/exact/clip_kernels.inc"

ClipKernelSet clipKernels() {
  return {hwy::TargetName(HWY_TARGET), clipKernelsOf<float>(), clipKernelsOf<double>()};
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
