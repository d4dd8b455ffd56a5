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
  static std::size_t lanes() { return 1; }
  static V load(const T* p) { return *p; }
  static void store(V v, T* p) { *p = v; }
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
  static M both(M a, M b) { return a && b; }
  static M either(M a, M b) { return a || b; }
  static M without(M a, M b) { return !a && b; }
  static bool all(M m) { return m; }
  static bool none(M m) { return !m; }
  static V choose(M m, V yes, V no) { return m ? yes : no; }
  static U noLabel() { return 0; }
  static U addLabel(U word, M m, std::uint32_t label) { return m ? word + label : word; }
  static void storeLabels(U word, U* p) { *p = word; }
};

#include "formfactor/exact/clip_kernels.inc"

}  // namespace

ClipKernelSet scalarClipKernels() {
  return {"scalar",
          {wholeLanes<float>, hiddenLanes<float>, commonLanes<float>},
          {wholeLanes<double>, hiddenLanes<double>, commonLanes<double>}};
}

}  // namespace radiosity
