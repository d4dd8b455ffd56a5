// Lambert's sum over the edges of a polygon: the integrator for near targets.
// Included once for every instruction set: Highway flips HWY_TARGET_TOGGLE in between.
#if defined(RADIOSITY_FORMFACTOR_EXACT_CLIP_ARCS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RADIOSITY_FORMFACTOR_EXACT_CLIP_ARCS_INL_H
#undef RADIOSITY_FORMFACTOR_EXACT_CLIP_ARCS_INL_H
#else
#define RADIOSITY_FORMFACTOR_EXACT_CLIP_ARCS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/clip_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

/// atan(sqrt(z)) / sqrt(z) on [0, 1], within 2e-8: the polynomial of degree 8 through the Chebyshev
/// nodes.
HWY_INLINE Vector<float> atanRatio(Vector<float> z) {
  const Tag<float> d;
  auto p = hn::Set(d, 0.0027662835F);
  p = hn::Add(hn::Mul(p, z), hn::Set(d, -0.015731249F));
  p = hn::Add(hn::Mul(p, z), hn::Set(d, 0.042137624F));
  p = hn::Add(hn::Mul(p, z), hn::Set(d, -0.074568548F));
  p = hn::Add(hn::Mul(p, z), hn::Set(d, 0.10618371F));
  p = hn::Add(hn::Mul(p, z), hn::Set(d, -0.14197798F));
  p = hn::Add(hn::Mul(p, z), hn::Set(d, 0.19991872F));
  p = hn::Add(hn::Mul(p, z), hn::Set(d, -0.33333037F));
  return hn::Add(hn::Mul(p, z), hn::Set(d, 0.99999998F));
}

/// The same within 1e-16: the angle is halved first, atan(t) = 2 atan(t / (1 + sqrt(1 + t^2))), and
/// the polynomial, of degree 10, is through the Chebyshev nodes of [0, tan(pi / 8)^2].
HWY_INLINE Vector<double> atanRatio(Vector<double> z) {
  const Tag<double> d;
  const auto one = hn::Set(d, 1.0);
  const auto scale = hn::Div(one, hn::Add(one, hn::Sqrt(hn::Add(one, z))));
  const auto h = hn::Mul(z, hn::Mul(scale, scale));
  auto p = hn::Set(d, 0.021135373157693246315);
  p = hn::Add(hn::Mul(p, h), hn::Set(d, -0.04348052215716462221));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, 0.056883492268090106447));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, -0.066402339304294080713));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, 0.076899534963068574833));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, -0.090907730748084142336));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, 0.1111110618045594578));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, -0.14285714180976466503));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, 0.19999999998855111372));
  p = hn::Add(hn::Mul(p, h), hn::Set(d, -0.33333333333328440951));
  p = hn::Add(hn::Mul(p, h), one);
  return hn::Mul(hn::Mul(p, scale), hn::Set(d, 2.0));
}

/// One edge's term of Lambert's sum, (n . c) atan2(|c|, a . b) / |c| with c = a x (b - a). For
/// angles below 45 degrees it is written with the tangent's square only: there is no root, and no
/// divisor can vanish.
template <class T>
HWY_INLINE Vector<T> arc(const Vector3<T>& a, const Vector3<T>& edge, const Vector3<T>& normal) {
  const Tag<T> d;
  const Vector3<T> c = cross3<T>(a, edge);
  const auto s2 = dot3<T>(c, c);
  const auto dot = hn::Add(dot3<T>(a, a), dot3<T>(a, edge));
  const auto flat = dot3<T>(normal, c);
  const auto zero = hn::Zero(d);
  const auto dot2 = hn::Mul(dot, dot);
  const auto narrow = hn::And(hn::Gt(dot, zero), hn::Ge(dot2, s2));
  const auto inverse = hn::Div(hn::Set(d, T(1)), dot);
  auto angle_over_sine = hn::Mul(
      inverse, atanRatio(hn::IfThenElse(narrow, hn::Mul(s2, hn::Mul(inverse, inverse)), zero)));
  if (!hn::AllTrue(d, narrow)) {
    // atan2 by octants, of the angle between a and b, 0 to pi.
    const auto s = hn::Sqrt(s2);
    const auto size = hn::Abs(dot);
    const auto steep = hn::Gt(s, size);
    const auto tangent = hn::Div(hn::IfThenElse(steep, size, s), hn::IfThenElse(steep, s, size));
    auto angle = hn::Mul(tangent, atanRatio(hn::Mul(tangent, tangent)));
    angle = hn::IfThenElse(steep, hn::Sub(hn::Set(d, T(1.57079632679489661923)), angle), angle);
    angle = hn::IfThenElse(hn::Gt(zero, dot), hn::Sub(hn::Set(d, T(3.14159265358979323846)), angle),
                           angle);
    const auto wide = hn::IfThenElse(hn::Gt(s, zero), hn::Div(angle, s), zero);
    angle_over_sine = hn::IfThenElse(narrow, angle_over_sine, wide);
  }
  return hn::Mul(flat, angle_over_sine);
}

template <class T>
HWY_INLINE Vector<T> formFactorOfSum(Vector<T> sum) {
  const Tag<T> d;
  // The sum is negative for a polygon whose front faces the eye. Rounding may say otherwise of one
  // that is seen edge on.
  return hn::Max(hn::Mul(sum, hn::Set(d, T(-0.15915494309189533577))), hn::Zero(d));
}

/// The form factor from the eye to a polygon given edge by edge.
template <class T>
class ArcSum {
 public:
  using V = Vector<T>;
  static constexpr std::size_t kSums = 1;

  /// `middle`, from the eye; `u`, `v`: the polygon's axes; `normal`: the eye's.
  HWY_INLINE ArcSum(const Vector3<T>& middle, const Vector3<T>& u, const Vector3<T>& v,
                    const Vector3<T>& normal)
      : middle_(middle), u_(u), v_(v), normal_(normal), sum_(hn::Zero(Tag<T>())) {}
  HWY_INLINE void add(const Vector2<T>& from, const Vector2<T>& to) {
    const Vector3<T> a = add3<T>(middle_, inPlane(from.u, from.v));
    sum_ = hn::Add(sum_, arc<T>(a, inPlane(hn::Sub(to.u, from.u), hn::Sub(to.v, from.v)), normal_));
  }
  HWY_INLINE V formFactor() const { return formFactorOfSum<T>(sum_); }
  /// Stores the sums so far, each kLaneAlignment after the other.
  HWY_INLINE void store(T* to) const { hn::Store(sum_, Tag<T>(), to); }
  /// Sets the sums of all lanes.
  HWY_INLINE void set(const T (&sums)[kSums]) { sum_ = hn::Set(Tag<T>(), sums[0]); }

 private:
  HWY_INLINE Vector3<T> inPlane(V u, V v) const {
    return {hn::Add(hn::Mul(u, u_.x), hn::Mul(v, v_.x)),
            hn::Add(hn::Mul(u, u_.y), hn::Mul(v, v_.y)),
            hn::Add(hn::Mul(u, u_.z), hn::Mul(v, v_.z))};
  }

  Vector3<T> middle_, u_, v_, normal_;
  V sum_;
};

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
