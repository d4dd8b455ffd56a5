// Lanes of numbers, of words and of indices; points in space and in a plane, one a lane.
// Included once for every instruction set: Highway flips HWY_TARGET_TOGGLE in between.
#if defined(RADIOSITY_FORMFACTOR_EXACT_CLIP_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RADIOSITY_FORMFACTOR_EXACT_CLIP_VECTORS_INL_H
#undef RADIOSITY_FORMFACTOR_EXACT_CLIP_VECTORS_INL_H
#else
#define RADIOSITY_FORMFACTOR_EXACT_CLIP_VECTORS_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "visibility/clipping/clip_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Not more lanes than arrays are filled up to.
template <class T>
using Tag = hn::CappedTag<T, kLaneAlignment>;
/// As many words, and indices, as numbers.
template <class T>
using WordTag = hn::RebindToUnsigned<Tag<T>>;
template <class T>
using IndexTag = hn::RebindToSigned<Tag<T>>;

template <class T>
using Vector = hn::Vec<Tag<T>>;
template <class T>
using Mask = hn::Mask<Tag<T>>;
template <class T>
using WordVector = hn::Vec<WordTag<T>>;
template <class T>
using IndexVector = hn::Vec<IndexTag<T>>;

/// word + other in the lanes of a mask.
template <class T>
HWY_INLINE WordVector<T> addWhere(WordVector<T> word, Mask<T> mask, WordVector<T> other) {
  return hn::Add(word, hn::IfThenElseZero(hn::RebindMask(WordTag<T>(), mask), other));
}

template <class T>
struct Vector2 {
  Vector<T> u, v;
};

template <class T>
struct Vector3 {
  Vector<T> x, y, z;
};

template <class T>
HWY_INLINE Vector3<T> load3(const T* const* from, std::size_t lane) {
  const Tag<T> d;
  return {hn::Load(d, from[0] + lane), hn::Load(d, from[1] + lane), hn::Load(d, from[2] + lane)};
}

template <class T>
HWY_INLINE Vector2<T> load2(const T* const* from, std::size_t lane) {
  const Tag<T> d;
  return {hn::Load(d, from[0] + lane), hn::Load(d, from[1] + lane)};
}

template <class T>
HWY_INLINE Vector3<T> set3(const T (&v)[3]) {
  const Tag<T> d;
  return {hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2])};
}

template <class T>
HWY_INLINE Vector3<T> add3(const Vector3<T>& a, const Vector3<T>& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

template <class T>
HWY_INLINE Vector3<T> sub3(const Vector3<T>& a, const Vector3<T>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class T>
HWY_INLINE Vector<T> dot3(const Vector3<T>& a, const Vector3<T>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class T>
HWY_INLINE Vector3<T> cross3(const Vector3<T>& a, const Vector3<T>& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

template <class T>
HWY_INLINE Vector2<T> choose2(Mask<T> mask, const Vector2<T>& yes, const Vector2<T>& no) {
  return {hn::IfThenElse(mask, yes.u, no.u), hn::IfThenElse(mask, yes.v, no.v)};
}

template <class T>
HWY_INLINE Vector3<T> gather3(const T* const* from, IndexVector<T> index) {
  const Tag<T> d;
  return {hn::GatherIndex(d, from[0], index), hn::GatherIndex(d, from[1], index),
          hn::GatherIndex(d, from[2], index)};
}

template <class T>
HWY_INLINE Vector2<T> gather2(const T* const* from, IndexVector<T> index) {
  const Tag<T> d;
  return {hn::GatherIndex(d, from[0], index), hn::GatherIndex(d, from[1], index)};
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
