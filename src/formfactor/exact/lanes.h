// One number handled like a vector of one lane, under the names Highway has: kernels written once
// run on vectors and, as their twin, on plain numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace radiosity::lanes {

// NOLINTBEGIN(readability-identifier-naming): Highway's names.
template <class T>
struct OneLane {
  using Number = T;
};

template <class T>
std::size_t Lanes(OneLane<T>) {
  return 1;
}
template <class T>
T Set(OneLane<T>, T x) {
  return x;
}
template <class T>
T Zero(OneLane<T>) {
  return T(0);
}
template <class T>
T LoadU(OneLane<T>, const T* from) {
  return *from;
}
template <class T>
void StoreU(T x, OneLane<T>, T* to) {
  *to = x;
}
template <class T>
bool FirstN(OneLane<T>, std::size_t n) {
  return n > 0;
}
template <class T>
bool AllFalse(OneLane<T>, bool mask) {
  return !mask;
}
template <class T>
std::size_t CountTrue(OneLane<T>, bool mask) {
  return mask ? 1 : 0;
}

#define RADIOSITY_LANE_FUNCTIONS(T)                 \
  inline T Add(T a, T b) { return a + b; }          \
  inline T Sub(T a, T b) { return a - b; }          \
  inline T Mul(T a, T b) { return a * b; }          \
  inline T Div(T a, T b) { return a / b; }          \
  inline T Sqrt(T a) { return std::sqrt(a); }       \
  inline T Abs(T a) { return std::abs(a); }         \
  inline T Max(T a, T b) { return std::max(a, b); } \
  inline T Min(T a, T b) { return std::min(a, b); } \
  inline bool Le(T a, T b) { return a <= b; }       \
  inline T IfThenElse(bool mask, T yes, T no) { return mask ? yes : no; }
RADIOSITY_LANE_FUNCTIONS(float)
RADIOSITY_LANE_FUNCTIONS(double)
#undef RADIOSITY_LANE_FUNCTIONS

inline bool And(bool a, bool b) { return a && b; }
/// Not a, and b.
inline bool AndNot(bool a, bool b) { return !a && b; }
// NOLINTEND(readability-identifier-naming)

}  // namespace radiosity::lanes
