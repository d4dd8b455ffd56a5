// Convex polygons cut by planes, one polygon a lane. Arithmetic is spelled out, operation by
// operation, since only a fixed order makes results equal.
// Included once for every instruction set: Highway flips HWY_TARGET_TOGGLE in between.
#if defined(RADIOSITY_FORMFACTOR_EXACT_CLIP_POLYGONS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RADIOSITY_FORMFACTOR_EXACT_CLIP_POLYGONS_INL_H
#undef RADIOSITY_FORMFACTOR_EXACT_CLIP_POLYGONS_INL_H
#else
#define RADIOSITY_FORMFACTOR_EXACT_CLIP_POLYGONS_INL_H
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstddef>

#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/clip_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

/// A line in a polygon's plane, where a plane meets it: a u + b v + c >= 0 inside.
template <class T>
struct Line {
  Vector<T> a, b, c;
  HWY_INLINE Vector<T> at(const Vector2<T>& p) const {
    return hn::Add(hn::Add(hn::Mul(a, p.u), hn::Mul(b, p.v)), c);
  }
};

/// A polygon as a list of directed edges, in its own coordinates; in any order, ends meet bit for
/// bit.
template <class T>
struct EdgeList {
  /// Gaps that may be closed besides those of convex polygons; see closeGaps().
  static constexpr std::size_t kMostGaps = kMostPlanes;
  static constexpr std::size_t kMost = kMostCorners + kMostPlanes + kMostGaps;

  alignas(64) T from[kMost][2][kLaneAlignment];
  alignas(64) T to[kMost][2][kLaneAlignment];
  std::size_t count = 0;
  std::size_t gaps = 0;  ///< closed so far

  HWY_INLINE Vector2<T> start(std::size_t k) const {
    const Tag<T> d;
    return {hn::Load(d, from[k][0]), hn::Load(d, from[k][1])};
  }
  HWY_INLINE Vector2<T> end(std::size_t k) const {
    const Tag<T> d;
    return {hn::Load(d, to[k][0]), hn::Load(d, to[k][1])};
  }
  HWY_INLINE void set(std::size_t k, const Vector2<T>& a, const Vector2<T>& b) {
    const Tag<T> d;
    hn::Store(a.u, d, from[k][0]);
    hn::Store(a.v, d, from[k][1]);
    hn::Store(b.u, d, to[k][0]);
    hn::Store(b.v, d, to[k][1]);
  }

  /// Cuts every edge to the inner side of a line, adds the edge along it and returns its number.
  /// `concerned`: lanes that are cut; the others stay. Points count as inside up to `noise`
  /// outside, so that an edge along the line lies on one side with all its points.
  HWY_INLINE std::size_t cut(const Line<T>& line, Vector<T> noise, Mask<T> concerned) {
    const Tag<T> d;
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, T(1));
    const auto least = hn::Sub(zero, noise);
    Vector2<T> leaves = {zero, zero};
    Vector2<T> enters = leaves;
    auto left = hn::Gt(zero, zero);
    auto left_again = left;
    for (std::size_t k = 0; k < count; ++k) {
      const Vector2<T> a = start(k);
      const Vector2<T> b = end(k);
      const auto at_a = line.at(a);
      const auto at_b = line.at(b);
      const auto a_out = hn::And(concerned, hn::Gt(least, at_a));
      const auto b_out = hn::And(concerned, hn::Gt(least, at_b));
      const auto t = hn::Min(hn::Max(hn::Div(at_a, hn::Sub(at_a, at_b)), zero), one);
      const Vector2<T> crossing = {hn::Add(a.u, hn::Mul(t, hn::Sub(b.u, a.u))),
                                   hn::Add(a.v, hn::Mul(t, hn::Sub(b.v, a.v)))};
      const auto leaving = hn::AndNot(a_out, b_out);
      const auto entering = hn::AndNot(b_out, a_out);
      left_again = hn::Or(left_again, hn::And(left, leaving));
      left = hn::Or(left, leaving);
      leaves = choose2<T>(leaving, crossing, leaves);
      enters = choose2<T>(entering, crossing, enters);
      // Wholly outside: both ends become `b`, an edge of no length.
      set(k, choose2<T>(a_out, choose2<T>(entering, crossing, b), a),
          choose2<T>(leaving, crossing, b));
    }
    const std::size_t along = count++;
    set(along, leaves, enters);
    if (!hn::AllFalse(d, left_again)) closeGaps(left_again);
    return along;
  }

  /// Adds edges from ends at which no edge starts to starts at which none ends. An outline is
  /// convex but for coincidence: a corner that lies back from its neighbours' line, if that is the
  /// line of a cut, leaves and enters the inner side as others do. All gaps are on one line, so
  /// that it does not matter which end is joined to which start.
  HWY_NOINLINE void closeGaps(Mask<T> open) {
    const Tag<T> d;
    alignas(64) T is_open[kLaneAlignment];
    hn::Store(hn::IfThenElseZero(open, hn::Set(d, T(1))), d, is_open);
    const std::size_t first = count;
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {
      if (is_open[lane] == 0) continue;
      std::array<LanePoint, kMost> ends;
      std::array<LanePoint, kMost> starts;
      const std::size_t missing = unmatched(lane, first, ends.data(), starts.data());
      for (std::size_t k = 0; k < missing; ++k) {
        if (first + k == count) {
          if (gaps == kMostGaps) return;
          ++gaps;
          set(count++, {hn::Zero(d), hn::Zero(d)}, {hn::Zero(d), hn::Zero(d)});
        }
        for (std::size_t axis = 0; axis < 2; ++axis) {
          from[first + k][axis][lane] = ends[k][axis];
          to[first + k][axis][lane] = starts[k][axis];
        }
      }
    }
  }

 private:
  using LanePoint = std::array<T, 2>;

  /// Finds the ends of a lane's first edges at which none of them starts, and as many starts at
  /// which none ends. Returns their number.
  std::size_t unmatched(std::size_t lane, std::size_t edge_count, LanePoint* ends,
                        LanePoint* starts) const {
    std::size_t end_count = 0;
    std::size_t start_count = 0;
    // Takes a point off one list, or puts it on the other.
    const auto match = [](const LanePoint& p, LanePoint* off, std::size_t& off_count, LanePoint* on,
                          std::size_t& on_count) {
      for (std::size_t k = 0; k < off_count; ++k) {
        if (off[k] != p) continue;
        off[k] = off[--off_count];
        return;
      }
      on[on_count++] = p;
    };
    for (std::size_t k = 0; k < edge_count; ++k) {
      const LanePoint a = {from[k][0][lane], from[k][1][lane]};
      const LanePoint b = {to[k][0][lane], to[k][1][lane]};
      match(a, ends, end_count, starts, start_count);
      match(b, starts, start_count, ends, end_count);
    }
    return std::min(end_count, start_count);
  }
};

/// The lines that cut each lane's polygon, in the order of their planes: the n-th of one lane
/// beside the n-th of another.
template <class T>
struct LaneLines {
  static constexpr std::size_t kMost = 4;

  std::array<Line<T>, kMost> line;
  std::array<WordVector<T>, kMost> label;
  std::size_t count = 0;  ///< of the lane that has most; more than kMost: not all are here
  Vector<T> rank;         ///< of each lane

  HWY_INLINE void clear() {
    count = 0;
    rank = hn::Zero(Tag<T>());
  }
  HWY_INLINE void add(const Line<T>& l, WordVector<T> name, Mask<T> concerned) {
    const Tag<T> d;
    for (std::size_t r = 0; r < kMost && r <= count; ++r) {
      const auto here = hn::And(concerned, hn::Eq(rank, hn::Set(d, T(r))));
      if (hn::AllFalse(d, here)) continue;
      // A lane without an r-th line has everything inside it.
      if (r == count) {
        line[r] = {hn::Zero(d), hn::Zero(d), hn::Set(d, T(1))};
        label[r] = hn::Zero(WordTag<T>());
        ++count;
      }
      line[r] = {hn::IfThenElse(here, l.a, line[r].a), hn::IfThenElse(here, l.b, line[r].b),
                 hn::IfThenElse(here, l.c, line[r].c)};
      label[r] = addWhere<T>(label[r], here, name);
    }
    rank = hn::IfThenElse(concerned, hn::Add(rank, hn::Set(d, T(1))), rank);
    if (!hn::AllFalse(d, hn::Gt(rank, hn::Set(d, T(kMost))))) count = kMost + 1;
  }
};

/// One vector of items.
template <class T>
struct VectorClip {
  // Leaves the arrays as they are: clearing them would take longer than the work on them.
  VectorClip(const TargetLanes<T>& all_targets, const EyePoints<T>& all_eyes,
             const ConePlanes<T>& all_planes)
      : targets(all_targets), eyes(all_eyes), planes(all_planes) {}

  const TargetLanes<T>& targets;
  const EyePoints<T>& eyes;
  const ConePlanes<T>& planes;
  Vector3<T> middle;  ///< from the eye
  Vector3<T> u, v;    ///< axes
  std::array<Vector2<T>, kMostCorners> corner;
  Vector<T> noise;
  Mask<T> nothing;  ///< lanes of which nothing is inside all planes
  Mask<T> cut;      ///< lanes that some plane cuts
  std::size_t line_count;
  std::array<std::size_t, kMostPlanes>
      edge_along;  ///< by plane or line: its edge, if it cuts a lane
  /// Each plane's line, and how far each polygon reaches out of it.
  alignas(64) T lines[kMostPlanes][4][kLaneAlignment];
  EdgeList<T> edges;
  LaneLines<T> own;

  HWY_INLINE void aim(const ClipItems<T>& items, std::size_t at) {
    const auto target = hn::Load(IndexTag<T>(), items.target + at);
    const auto eye = hn::Load(IndexTag<T>(), items.eye + at);
    middle = sub3<T>(gather3<T>(targets.middle, target), gather3<T>(eyes.position, eye));
    u = gather3<T>(targets.axis[0], target);
    v = gather3<T>(targets.axis[1], target);
    for (std::size_t k = 0; k < targets.corners; ++k) {
      corner[k] = gather2<T>(targets.corner[k], target);
    }
    noise = hn::Mul(hn::Set(Tag<T>(), kPlaneNoise<T>), hn::Sqrt(dot3<T>(middle, middle)));
    nothing = hn::Gt(noise, noise);
    cut = nothing;
    line_count = 0;
  }

  /// Finds the place of each polygon relative to a plane of its own.
  HWY_INLINE void classify(IndexVector<T> plane) {
    const Tag<T> d;
    const Vector3<T> normal = gather3<T>(planes.normal, plane);
    const Line<T> line = {
        dot3<T>(normal, u), dot3<T>(normal, v),
        hn::Add(dot3<T>(normal, middle), hn::GatherIndex(d, planes.offset, plane))};
    auto low = line.at(corner[0]);
    auto high = low;
    for (std::size_t k = 1; k < targets.corners; ++k) {
      const auto height = line.at(corner[k]);
      low = hn::Min(low, height);
      high = hn::Max(high, height);
    }
    nothing = hn::Or(nothing, hn::Ge(noise, high));
    cut = hn::Or(cut, hn::Gt(hn::Sub(hn::Zero(d), noise), low));
    T(&to)[4][kLaneAlignment] = lines[line_count++];
    hn::Store(line.a, d, to[0]);
    hn::Store(line.b, d, to[1]);
    hn::Store(line.c, d, to[2]);
    hn::Store(low, d, to[3]);
  }

  /// Lanes that a plane cuts, of those classified.
  HWY_INLINE Mask<T> cutBy(std::size_t p) const {
    const Tag<T> d;
    return hn::Gt(hn::Sub(hn::Zero(d), noise), hn::Load(d, lines[p][3]));
  }
  HWY_INLINE Line<T> line(std::size_t p) const {
    const Tag<T> d;
    return {hn::Load(d, lines[p][0]), hn::Load(d, lines[p][1]), hn::Load(d, lines[p][2])};
  }

  HWY_INLINE void startEdges() {
    for (std::size_t k = 0; k < targets.corners; ++k) {
      edges.set(k, corner[k > 0 ? k - 1 : targets.corners - 1], corner[k]);
    }
    edges.count = targets.corners;
    edges.gaps = 0;
  }

  /// Cuts the polygons of `concerned` lanes, plane after plane.
  HWY_INLINE void cutByPlanes(Mask<T> concerned) {
    startEdges();
    for (std::size_t p = 0; p < line_count; ++p) {
      const auto here = hn::And(concerned, cutBy(p));
      if (!hn::AllFalse(Tag<T>(), here)) edge_along[p] = edges.cut(line(p), noise, here);
    }
  }

  template <class Integral>
  HWY_INLINE Vector<T> formFactor(const Vector3<T>& normal) const {
    Integral sum(middle, u, v, normal);
    for (std::size_t k = 0; k < edges.count; ++k) sum.add(edges.start(k), edges.end(k));
    return sum.formFactor();
  }
  /// Adds a label where an edge has a length.
  HWY_INLINE WordVector<T> addEdge(WordVector<T> word, std::size_t edge, WordVector<T> label,
                                   Mask<T> concerned) const {
    const Vector2<T> a = edges.start(edge);
    const Vector2<T> b = edges.end(edge);
    const auto has_length = hn::Or(hn::Ne(a.u, b.u), hn::Ne(a.v, b.v));
    return addWhere<T>(word, hn::And(concerned, has_length), label);
  }
};

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
