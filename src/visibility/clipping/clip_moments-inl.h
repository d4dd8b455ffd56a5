// The kernel cos cos / (pi r^2) about the middle of a polygon to second order, integrated exactly:
// the integrator for far targets.
// Included once for every instruction set: Highway flips HWY_TARGET_TOGGLE in between.
#if defined(RADIOSITY_FORMFACTOR_EXACT_CLIP_MOMENTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RADIOSITY_FORMFACTOR_EXACT_CLIP_MOMENTS_INL_H
#undef RADIOSITY_FORMFACTOR_EXACT_CLIP_MOMENTS_INL_H
#else
#define RADIOSITY_FORMFACTOR_EXACT_CLIP_MOMENTS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/clip_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

/// The form factor from the eye to a polygon given edge by edge. With the polygon's point p + d, p
/// its middle, n the eye's normal and s = 2 (p.u, p.v) / p.p, the kernel is
///   n.(p + d) (1 + s.d + d.d / p.p)^-2 = n.(p + d) (1 - 2 s.d + 3 (s.d)^2 - 2 d.d / p.p + ...)
/// times a factor without d. Terms of third order in d are left out. Unlike a sum of arcs it loses
/// no digits for a small polygon. A polygon's parts add up to the whole.
template <class T>
class MomentSum {
 public:
  using V = Vector<T>;
  static constexpr std::size_t kSums = 6;

  HWY_INLINE MomentSum(const Vector3<T>& middle, const Vector3<T>& u, const Vector3<T>& v,
                       const Vector3<T>& normal)
      : middle_(middle), u_(u), v_(v), normal_(normal) {
    area_ = of_u_ = of_v_ = of_uu_ = of_uv_ = of_vv_ = hn::Zero(Tag<T>());
  }
  /// Adds the triangle of the edge and the middle, in multiples (2, 6, 12, 24) of its moments.
  HWY_INLINE void add(const Vector2<T>& a, const Vector2<T>& b) {
    const V twice = hn::Sub(hn::Mul(a.u, b.v), hn::Mul(b.u, a.v));
    const V u = hn::Add(a.u, b.u);
    const V v = hn::Add(a.v, b.v);
    area_ = hn::Add(area_, twice);
    of_u_ = hn::Add(of_u_, hn::Mul(twice, u));
    of_v_ = hn::Add(of_v_, hn::Mul(twice, v));
    of_uu_ = hn::Add(of_uu_, hn::Mul(twice, hn::Add(hn::Mul(a.u, u), hn::Mul(b.u, b.u))));
    of_vv_ = hn::Add(of_vv_, hn::Mul(twice, hn::Add(hn::Mul(a.v, v), hn::Mul(b.v, b.v))));
    const V own = hn::Add(hn::Mul(a.u, a.v), hn::Mul(b.u, b.v));
    of_uv_ = hn::Add(of_uv_, hn::Mul(twice, hn::Add(own, hn::Mul(u, v))));
  }
  /// Stores the sums so far, each kLaneAlignment after the other.
  HWY_INLINE void store(T* to) const {
    const Tag<T> d;
    hn::Store(area_, d, to);
    hn::Store(of_u_, d, to + kLaneAlignment);
    hn::Store(of_v_, d, to + 2 * kLaneAlignment);
    hn::Store(of_uu_, d, to + 3 * kLaneAlignment);
    hn::Store(of_uv_, d, to + 4 * kLaneAlignment);
    hn::Store(of_vv_, d, to + 5 * kLaneAlignment);
  }
  /// Sets the sums of all lanes.
  HWY_INLINE void set(const T (&sums)[kSums]) {
    const Tag<T> d;
    area_ = hn::Set(d, sums[0]);
    of_u_ = hn::Set(d, sums[1]);
    of_v_ = hn::Set(d, sums[2]);
    of_uu_ = hn::Set(d, sums[3]);
    of_uv_ = hn::Set(d, sums[4]);
    of_vv_ = hn::Set(d, sums[5]);
  }
  HWY_INLINE V formFactor() const {
    const Tag<T> d;
    const V inverse = hn::Div(hn::Set(d, T(1)), dot3<T>(middle_, middle_));
    const V two = hn::Set(d, T(2));
    const V su = hn::Mul(hn::Mul(two, inverse), dot3<T>(middle_, u_));
    const V sv = hn::Mul(hn::Mul(two, inverse), dot3<T>(middle_, v_));
    const V nu = dot3<T>(normal_, u_);
    const V nv = dot3<T>(normal_, v_);
    const V m = hn::Mul(area_, hn::Set(d, T(1.0 / 2)));
    const V mu = hn::Mul(of_u_, hn::Set(d, T(1.0 / 6)));
    const V mv = hn::Mul(of_v_, hn::Set(d, T(1.0 / 6)));
    const V muu = hn::Mul(of_uu_, hn::Set(d, T(1.0 / 12)));
    const V mvv = hn::Mul(of_vv_, hn::Set(d, T(1.0 / 12)));
    const V muv = hn::Mul(of_uv_, hn::Set(d, T(1.0 / 24)));
    // Integrals of (s.d), (s.d) d and d.d.
    const V first = hn::Add(hn::Mul(su, mu), hn::Mul(sv, mv));
    const V along_u = hn::Add(hn::Mul(su, muu), hn::Mul(sv, muv));
    const V along_v = hn::Add(hn::Mul(su, muv), hn::Mul(sv, mvv));
    const V second = hn::Add(hn::Mul(su, along_u), hn::Mul(sv, along_v));
    const V round = hn::Mul(inverse, hn::Add(muu, mvv));
    const V at_middle =
        hn::Sub(hn::Add(m, hn::Mul(hn::Set(d, T(3)), second)), hn::Mul(two, hn::Add(first, round)));
    const V tilt = hn::Add(hn::Mul(nu, hn::Sub(mu, hn::Mul(two, along_u))),
                           hn::Mul(nv, hn::Sub(mv, hn::Mul(two, along_v))));
    const V sum = hn::Add(hn::Mul(dot3<T>(normal_, middle_), at_middle), tilt);
    const V distance = hn::Sub(hn::Zero(d), dot3<T>(middle_, cross3<T>(u_, v_)));
    const V scale = hn::Mul(hn::Mul(distance, hn::Set(d, T(0.31830988618379067154))),
                            hn::Mul(inverse, inverse));
    return hn::Max(hn::Mul(scale, sum), hn::Zero(d));
  }

 private:
  Vector3<T> middle_, u_, v_, normal_;
  V area_, of_u_, of_v_, of_uu_, of_uv_, of_vv_;
};

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
