#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "formfactor/exact/clip_kernels.h"

#define CLIP_INLINE inline

namespace radiosity {
namespace {

/// One lane a vector.
template <class T>
struct Ops {
  using V = T;
  using M = bool;
  using U = ShapeWord<T>;
  using I = LaneIndex<T>;
  static std::size_t lanes() { return 1; }
  static V load(const T* p) { return *p; }
  static void store(V v, T* p) { *p = v; }
  template <class To>
  static void storeAs(V v, To* p) {
    *p = To(v);
  }
  static V set(T v) { return v; }
  static V add(V a, V b) { return a + b; }
  static V sub(V a, V b) { return a - b; }
  static V mul(V a, V b) { return a * b; }
  static V div(V a, V b) { return a / b; }
  static V sqrt(V a) { return std::sqrt(a); }
  static V abs(V a) { return std::abs(a); }
  static V min(V a, V b) { return a < b ? a : b; }
  static V max(V a, V b) { return a > b ? a : b; }
  static M greater(V a, V b) { return a > b; }
  static M greaterEqual(V a, V b) { return a >= b; }
  static M equal(V a, V b) { return a == b; }
  static M notEqual(V a, V b) { return a != b; }
  static M both(M a, M b) { return a && b; }
  static M either(M a, M b) { return a || b; }
  static M without(M a, M b) { return !a && b; }
  static bool all(M m) { return m; }
  static bool none(M m) { return !m; }
  static std::uint32_t bits(M m) { return m ? 1 : 0; }
  static V choose(M m, V yes, V no) { return m ? yes : no; }
  static U noLabel() { return 0; }
  static U setWord(std::uint32_t word) { return word; }
  static U addWord(U word, M m, U other) { return m ? word + other : word; }
  static void storeWord(U word, U* p) { *p = word; }
  static I loadIndex(const LaneIndex<T>* p) { return *p; }
  static V gather(const T* from, I index) { return from[index]; }
  static U gatherWord(const U* from, I index) { return from[index]; }
  static I after(I first, std::size_t k) { return first + I(k); }
  /// The k-th plane of a cone, or one that does nothing.
  static I planeOf(I first, I count, std::size_t k) {
    return I(k) < count ? first + I(k) : ConePlanes<T>::kAllInside;
  }
};

#include "formfactor/exact/clip_kernels.inc"

}  // namespace

ClipKernelSet scalarClipKernels() {
  return {"scalar", clipKernelsOf<float>(), clipKernelsOf<double>()};
}

}  // namespace radiosity
