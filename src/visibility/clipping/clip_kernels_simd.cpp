#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "visibility/clipping/clip_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "visibility/clipping/clip_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

#include "visibility/clipping/clip_arcs-inl.h"
#include "visibility/clipping/clip_moments-inl.h"
#include "visibility/clipping/clip_polygons-inl.h"
#include "visibility/clipping/clip_vectors-inl.h"
#include "visibility/clipping/cone_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

/// Shapes start with the polygon's own edges; any odd constants would do.
constexpr std::uint32_t kEdgeLabel = 0x9e3779b9U;

template <class T, class Integral>
void wholeLanes(const TargetLanes<T>& targets, const EyePoint<T>& eye, T* form_factor) {
  const Tag<T> d;
  const Vector3<T> position = set3<T>(eye.position);
  const Vector3<T> normal = set3<T>(eye.normal);
  for (std::size_t lane = 0; lane < targets.count; lane += hn::Lanes(d)) {
    Integral sum(sub3<T>(load3<T>(targets.middle, lane), position), load3<T>(targets.axis[0], lane),
                 load3<T>(targets.axis[1], lane), normal);
    Vector2<T> from = load2<T>(targets.corner[targets.corners - 1], lane);
    for (std::size_t k = 0; k < targets.corners; ++k) {
      const Vector2<T> to = load2<T>(targets.corner[k], lane);
      sum.add(from, to);
      from = to;
    }
    hn::Store(sum.formFactor(), d, form_factor + lane);
  }
}

/// Cuts the polygons of `concerned` lanes to their parts inside all of their cones' planes. Returns
/// the sums of the labels of the edges that have a length then.
template <class T>
HWY_INLINE WordVector<T> cutToCone(VectorClip<T>& clip, IndexVector<T> first_plane,
                                   Mask<T> concerned) {
  const Tag<T> d;
  const std::size_t corners = clip.targets.corners;
  const auto label = [&](std::size_t p) HWY_ATTR {
    const auto plane = hn::Add(first_plane, hn::Set(IndexTag<T>(), LaneIndex<T>(p)));
    return hn::GatherIndex(WordTag<T>(), clip.planes.label, plane);
  };
  LaneLines<T>& own = clip.own;
  own.clear();
  for (std::size_t p = 0; p < clip.line_count && own.count <= own.kMost; ++p) {
    const auto here = hn::And(concerned, clip.cutBy(p));
    if (!hn::AllFalse(d, here)) own.add(clip.line(p), label(p), here);
  }
  auto word = hn::Zero(WordTag<T>());
  if (own.count <= own.kMost) {
    clip.startEdges();
    for (std::size_t r = 0; r < own.count; ++r) {
      clip.edge_along[r] = clip.edges.cut(own.line[r], clip.noise, concerned);
    }
    for (std::size_t r = 0; r < own.count; ++r) {
      word = clip.addEdge(word, clip.edge_along[r], own.label[r], concerned);
    }
  } else {
    clip.cutByPlanes(concerned);
    for (std::size_t p = 0; p < clip.line_count; ++p) {
      const auto here = hn::And(concerned, clip.cutBy(p));
      if (!hn::AllFalse(d, here)) word = clip.addEdge(word, clip.edge_along[p], label(p), here);
    }
  }
  for (std::size_t k = 0; k < corners; ++k) {
    const std::uint32_t name = kEdgeLabel * std::uint32_t(2 * k + 1);
    word = clip.addEdge(word, k, hn::Set(WordTag<T>(), ShapeWord<T>(name)), concerned);
  }
  return word;
}

/// The largest plane count among a vector's lanes.
template <class T>
HWY_INLINE std::size_t mostPlanes(const LaneIndex<T>* plane_count) {
  return std::size_t(*std::max_element(plane_count, plane_count + hn::Lanes(Tag<T>())));
}

/// The k-th plane of a cone, or one that does nothing.
template <class T>
HWY_INLINE IndexVector<T> planeOf(IndexVector<T> first, IndexVector<T> count, std::size_t k) {
  const auto number = hn::Set(IndexTag<T>(), LaneIndex<T>(k));
  static_assert(ConePlanes<T>::kAllInside == 0);
  return hn::IfThenElseZero(hn::Lt(number, count), hn::Add(first, number));
}

template <class T, class Integral>
void hiddenLanes(const TargetLanes<T>& targets, const EyePoints<T>& eyes,
                 const ConePlanes<T>& planes, const ClipItems<T>& items,
                 const LaneIndex<T>* first_plane, const LaneIndex<T>* plane_count,
                 const HiddenParts<T>& out) {
  const Tag<T> d;
  const Vector3<T> normal = set3<T>(eyes.normal);
  VectorClip<T> clip(targets, eyes, planes);
  for (std::size_t at = 0; at < items.count; at += hn::Lanes(d)) {
    clip.aim(items, at);
    const auto first = hn::Load(IndexTag<T>(), first_plane + at);
    const auto count = hn::Load(IndexTag<T>(), plane_count + at);
    const std::size_t most = mostPlanes<T>(plane_count + at);
    for (std::size_t p = 0; p < most; ++p) clip.classify(planeOf<T>(first, count, p));
    const auto concerned = hn::AndNot(clip.nothing, clip.cut);
    auto value = hn::IfThenElse(clip.nothing, hn::Zero(d), hn::Set(d, T(kHiddenWhole)));
    auto word = hn::Zero(WordTag<T>());
    auto low = hn::Zero(WordTag<T>());
    auto high = hn::Zero(WordTag<T>());
    if (!hn::AllFalse(d, concerned)) {
      word = cutToCone<T>(clip, first, concerned);
      value = hn::IfThenElse(concerned, clip.template formFactor<Integral>(normal), value);
      for (std::size_t p = 0; p < most && p < 64; ++p) {
        const auto here = hn::And(concerned, clip.cutBy(p));
        const std::uint32_t mask = std::uint32_t(1) << p % 32;
        const auto bit = hn::Set(WordTag<T>(), ShapeWord<T>(mask));
        if (p < 32) low = addWhere<T>(low, here, bit);
        if (p >= 32) high = addWhere<T>(high, here, bit);
      }
    }
    hn::Store(value, d, out.form_factor + at);
    hn::Store(word, WordTag<T>(), out.shape + at);
    hn::Store(low, WordTag<T>(), out.cut_low + at);
    hn::Store(high, WordTag<T>(), out.cut_high + at);
  }
}

template <class T, class Integral>
void commonLanes(const TargetLanes<T>& targets, const EyePoints<T>& eyes,
                 const ConePlanes<T>& planes, const ClipItems<T>& items,
                 const LaneIndex<T>* const* own_planes, const LaneIndex<T>* plane_count,
                 T* form_factor) {
  const Tag<T> d;
  const Vector3<T> normal = set3<T>(eyes.normal);
  VectorClip<T> clip(targets, eyes, planes);
  for (std::size_t at = 0; at < items.count; at += hn::Lanes(d)) {
    clip.aim(items, at);
    const std::size_t most = mostPlanes<T>(plane_count + at);
    for (std::size_t p = 0; p < most; ++p) {
      clip.classify(hn::Load(IndexTag<T>(), own_planes[p] + at));
    }
    const auto concerned = hn::AndNot(clip.nothing, clip.cut);
    auto value = hn::Zero(d);
    if (!hn::AllFalse(d, concerned)) {
      clip.cutByPlanes(concerned);
      value = hn::IfThenElse(concerned, clip.template formFactor<Integral>(normal), value);
    }
    hn::Store(value, d, form_factor + at);
  }
}

/// A lane an edge. The sums of lanes are added up in an order that does not depend on how many a
/// vector has.
template <class T, class Integral>
T partsOfTarget(const TargetLanes<T>& targets, std::size_t target, const EyePoint<T>& eye,
                const FlatEdges<T>& edges) {
  const Tag<T> d;
  const auto at = [&](const T* const* row) HWY_ATTR {
    return Vector3<T>{hn::Set(d, row[0][target]), hn::Set(d, row[1][target]),
                      hn::Set(d, row[2][target])};
  };
  const Vector3<T> middle = sub3<T>(at(targets.middle), set3<T>(eye.position));
  const Integral none(middle, at(targets.axis[0]), at(targets.axis[1]), set3<T>(eye.normal));
  alignas(64) T sums[Integral::kSums][kLaneAlignment];
  for (std::size_t lane = 0; lane < kLaneAlignment; lane += hn::Lanes(d)) {
    Integral sum = none;
    for (std::size_t k = lane; k < edges.count; k += kLaneAlignment) {
      sum.add(load2<T>(edges.from, k), load2<T>(edges.to, k));
    }
    sum.store(&sums[0][lane]);
  }
  T totals[Integral::kSums];
  for (std::size_t s = 0; s < Integral::kSums; ++s) {
    totals[s] = sums[s][0];
    for (std::size_t lane = 1; lane < kLaneAlignment; ++lane) totals[s] += sums[s][lane];
  }
  Integral sum = none;
  sum.set(totals);
  alignas(64) T value[kLaneAlignment];
  hn::Store(sum.formFactor(), d, value);
  return value[0];
}

template <class T>
ClipKernels<T> kernelsIn() {
  return {{wholeLanes<T, ArcSum<T>>, hiddenLanes<T, ArcSum<T>>, commonLanes<T, ArcSum<T>>,
           partsOfTarget<T, ArcSum<T>>},
          {wholeLanes<T, MomentSum<T>>, hiddenLanes<T, MomentSum<T>>, commonLanes<T, MomentSum<T>>,
           partsOfTarget<T, MomentSum<T>>},
          coneSides<T>,
          pointsThatMiss};
}

ClipKernelSet kernels() {
  return {hwy::TargetName(HWY_TARGET), kernelsIn<float>(), kernelsIn<double>()};
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

ClipKernelSet clipKernels(bool simd) {
  return (simd ? HWY_DYNAMIC_DISPATCH(kernels) : HWY_CHOOSE_FALLBACK(kernels))();
}

}  // namespace radiosity
#endif
