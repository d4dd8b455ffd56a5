#include "formfactor/rays/ray_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "formfactor/rays/ray_kernels_simd.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once per instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, kRayLanes>;
using Words = hn::RebindToUnsigned<Floats>;
using Ints = hn::RebindToSigned<Floats>;
using Shorts = hn::Rebind<std::uint16_t, Ints>;
using Float = hn::Vec<Floats>;
using Word = hn::Vec<Words>;
using Int = hn::Vec<Ints>;

/// Vectors in space, or in the plane without z.
struct Place {
  Float x;
  Float y;
  Float z;
};

HWY_INLINE Float set(float value) { return hn::Set(Floats(), value); }
HWY_INLINE Int set(std::int32_t value) { return hn::Set(Ints(), value); }

HWY_INLINE Word reverseBits(Word x) {
  const Words d;
  const auto swap = [&](Word v, std::uint32_t low, auto shift) HWY_ATTR {
    constexpr int kShift = decltype(shift)::value;
    const auto mask = hn::Set(d, low);
    return hn::Or(hn::ShiftLeft<kShift>(hn::And(v, mask)),
                  hn::And(hn::ShiftRight<kShift>(v), mask));
  };
  x = hn::Or(hn::ShiftRight<16>(x), hn::ShiftLeft<16>(x));
  x = swap(x, 0x00ff00ffu, std::integral_constant<int, 8>());
  x = swap(x, 0x0f0f0f0fu, std::integral_constant<int, 4>());
  x = swap(x, 0x33333333u, std::integral_constant<int, 2>());
  return swap(x, 0x55555555u, std::integral_constant<int, 1>());
}

/// A permutation in which every bit depends on lower ones alone (Laine and Karras 2011, constants
/// of Burley 2020): on bit-reversed numbers, a nested uniform scrambling.
HWY_INLINE Word nestedPermutation(Word x, Word seed) {
  const Words d;
  x = hn::Add(x, seed);
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0x6c50b47cu)));
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0xb82f1e52u)));
  x = hn::Xor(x, hn::Mul(x, hn::Set(d, 0xc7afe638u)));
  return hn::Xor(x, hn::Mul(x, hn::Set(d, 0x8d22f6e6u)));
}

void scramble(const std::uint32_t* first, std::size_t count, std::uint32_t base, std::uint32_t seed,
              float* out) {
  const Floats df;
  const Words dw;
  const std::size_t lanes = hn::Lanes(df);
  const auto bases = hn::Set(dw, base);
  const auto seeds = hn::Set(dw, seed);
  for (std::size_t k = 0; k < count; k += lanes) {
    const Word x = hn::Xor(hn::LoadU(dw, first + k), bases);
    const Word bits = hn::ShiftRight<8>(reverseBits(nestedPermutation(x, seeds)));
    const Float point = hn::Mul(hn::ConvertTo(df, hn::BitCast(Ints(), bits)), set(0x1p-24F));
    if (k + lanes <= count) {
      hn::StoreU(point, df, out + k);
    } else {
      // Not BlendedStore, which may write old values beyond.
      alignas(64) float last[kRayLanes];
      hn::Store(point, df, last);
      for (std::size_t m = k; m < count; ++m) out[m] = last[m - k];
    }
  }
}

/// cos and sin of angles up to pi / 4, to 1e-7; y: the angle squared.
HWY_INLINE Float smallCos(Float y) {
  Float sum = hn::Add(set(-1.0F / 720), hn::Mul(y, set(1.0F / 40320)));
  sum = hn::Add(set(1.0F / 24), hn::Mul(y, sum));
  sum = hn::Add(set(-0.5F), hn::Mul(y, sum));
  return hn::Add(set(1.0F), hn::Mul(y, sum));
}
HWY_INLINE Float smallSin(Float x, Float y) {
  Float sum = hn::Add(set(1.0F / 120), hn::Mul(y, set(-1.0F / 5040)));
  sum = hn::Add(set(-1.0F / 6), hn::Mul(y, sum));
  return hn::Mul(x, hn::Add(set(1.0F), hn::Mul(y, sum)));
}

/// Points of the unit disc (Shirley and Chiu 1997, concentric), which keeps neighbours together.
HWY_INLINE void toDiscLanes(Float x, Float y, Float& u, Float& v) {
  const Floats d;
  const Float a = hn::Sub(hn::Mul(set(2.0F), x), set(1.0F));
  const Float b = hn::Sub(hn::Mul(set(2.0F), y), set(1.0F));
  const auto wide = hn::Gt(hn::Abs(a), hn::Abs(b));
  const Float radius = hn::IfThenElse(wide, a, b);
  const Float other = hn::IfThenElse(wide, b, a);
  const Float ratio = hn::IfThenElseZero(hn::Ne(radius, hn::Zero(d)), hn::Div(other, radius));
  const Float angle = hn::Mul(set(0.785398163F), ratio);
  const Float square = hn::Mul(angle, angle);
  const Float along = hn::Mul(radius, smallCos(square));
  const Float across = hn::Mul(radius, smallSin(angle, square));
  u = hn::IfThenElse(wide, along, across);
  v = hn::IfThenElse(wide, across, along);
}

void toDisc(const float* x, const float* y, std::size_t count, float* u, float* v) {
  const Floats d;
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    Float disc_u = hn::Zero(d);
    Float disc_v = hn::Zero(d);
    toDiscLanes(hn::LoadU(d, x + k), hn::LoadU(d, y + k), disc_u, disc_v);
    hn::StoreU(disc_u, d, u + k);
    hn::StoreU(disc_v, d, v + k);
  }
}

/// Directions in a window (DirectionWindow), in the axes of the frame.
HWY_INLINE Place inWindow(const RayOrigins& from, Float low, Float across, Float x, Float y) {
  const Floats d;
  const Float higher = hn::Mul(set(from.range()), x);
  const Float height = hn::Sqrt(hn::Add(low, higher));
  const Float radius = hn::Sqrt(hn::Max(hn::Zero(d), hn::Sub(across, higher)));
  // cos and sin of a quarter of the angle, doubled twice.
  const Float turn = hn::Sub(hn::Mul(set(2.0F), y), set(1.0F));
  const Float quarter = hn::Mul(set(0.25F * from.halfTurn()), turn);
  const Float square = hn::Mul(quarter, quarter);
  Float cosine = smallCos(square);
  Float sine = smallSin(quarter, square);
  for (int k = 0; k < 2; ++k) {
    const Float twice = hn::Mul(set(2.0F), sine);
    const Float next = hn::Sub(set(1.0F), hn::Mul(twice, sine));
    sine = hn::Mul(twice, cosine);
    cosine = next;
  }
  return {hn::Mul(radius, cosine), hn::Mul(radius, sine), height};
}

/// Directions of the hemisphere.
HWY_INLINE Place overPlane(Float x, Float y) {
  const Floats d;
  Float u = hn::Zero(d);
  Float v = hn::Zero(d);
  toDiscLanes(x, y, u, v);
  const Float w =
      hn::Sqrt(hn::Max(hn::Zero(d), hn::Sub(hn::Sub(set(1.0F), hn::Mul(u, u)), hn::Mul(v, v))));
  return {u, v, w};
}

/// Component by component of a table's entries; one for all lanes, or each lane's own.
class Entries {
 public:
  template <class Entry>
  HWY_INLINE explicit Entries(const Entry* table) : words_(reinterpret_cast<const float*>(table)) {
    static_assert(sizeof(Entry) % sizeof(float) == 0);
  }
  template <class Entry>
  HWY_INLINE Entries(const Entry* table, Int which) : Entries(table) {
    own_ = true;
    at_ = hn::Mul(which, set(std::int32_t(sizeof(Entry) / sizeof(float))));
  }
  HWY_INLINE Float real(int word) const {
    return own_ ? hn::GatherIndex(Floats(), words_ + word, at_) : set(words_[word]);
  }
  HWY_INLINE Int whole(int word) const { return hn::BitCast(Ints(), real(word)); }
  HWY_INLINE Place place(int word) const { return {real(word), real(word + 1), real(word + 2)}; }

 private:
  const float* words_;
  bool own_ = false;
  Int at_ = hn::Zero(Ints());
};

HWY_INLINE Place add(const Place& a, const Place& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Place times(Float s, const Place& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}

/// Points of the parts at (x, y) in [0, 1)^2; areas keep their ratios. In a triangle,
/// corner + root x ((1 - y) ab + y ac).
HWY_INLINE Place pointsAt(const Entries& part, Float x, Float y) {
  using Part = RayOrigins::Part;
  const Place corner = part.place(offsetof(Part, corner) / sizeof(float));
  const Place ab = part.place(offsetof(Part, ab) / sizeof(float));
  const Place ac = part.place(offsetof(Part, ac) / sizeof(float));
  const auto parallelogram = hn::RebindMask(
      Floats(), hn::Ne(part.whole(offsetof(Part, parallelogram) / sizeof(float)), set(0)));
  const Place in_parallelogram = add(add(corner, times(x, ab)), times(y, ac));
  const Place across = add(times(hn::Sub(set(1.0F), y), ab), times(y, ac));
  const Place in_triangle = add(corner, times(hn::Sqrt(x), across));
  return {hn::IfThenElse(parallelogram, in_parallelogram.x, in_triangle.x),
          hn::IfThenElse(parallelogram, in_parallelogram.y, in_triangle.y),
          hn::IfThenElse(parallelogram, in_parallelogram.z, in_triangle.z)};
}

/// The cell of a coordinate in [0, 1].
HWY_INLINE Int cellOf(Float x) {
  constexpr auto kCells = std::int32_t(kDirectionCells);
  return hn::Min(hn::ConvertTo(Ints(), hn::Mul(x, set(float(kCells)))), set(kCells - 1));
}

/// The bits of a number below kDirectionCells with a 0 before each.
HWY_INLINE Int spread(Int x) {
  x = hn::And(hn::Or(x, hn::ShiftLeft<4>(x)), set(0x10f));
  x = hn::And(hn::Or(x, hn::ShiftLeft<2>(x)), set(0x133));
  return hn::And(hn::Or(x, hn::ShiftLeft<1>(x)), set(0x155));
}

/// Places of cells along a Z curve.
HWY_INLINE Int zCurve(Float x, Float y) {
  return hn::Or(spread(cellOf(x)), hn::ShiftLeft<1>(spread(cellOf(y))));
}

void store(const Place& place, const std::array<float*, 3>& to, std::size_t k) {
  const Floats d;
  hn::StoreU(place.x, d, to[0] + k);
  hn::StoreU(place.y, d, to[1] + k);
  hn::StoreU(place.z, d, to[2] + k);
}

void aim(const RayOrigins& from, std::size_t count, const RayArrays& rays) {
  const Floats d;
  const Ints di;
  const Entries frame(&from.frame());
  const Place z = frame.place(offsetof(RayFrame, z) / sizeof(float));
  for (std::size_t k = 0; k < count; k += hn::Lanes(d)) {
    const Entries part = rays.part == nullptr
                             ? Entries(&from.part(0))
                             : Entries(&from.part(0), hn::LoadU(di, rays.part + k));
    const Place point =
        pointsAt(part, hn::LoadU(d, rays.points[0] + k), hn::LoadU(d, rays.points[1] + k));
    store(add(point, times(set(kRayLift), z)), rays.origin, k);
    const Float x = hn::LoadU(d, rays.points[2] + k);
    const Float y = hn::LoadU(d, rays.points[3] + k);
    const Place over = from.isAimed()
                           ? inWindow(from, frame.real(offsetof(RayFrame, low) / sizeof(float)),
                                      frame.real(offsetof(RayFrame, across) / sizeof(float)), x, y)
                           : overPlane(x, y);
    const Place along = add(add(times(over.x, frame.place(offsetof(RayFrame, x) / sizeof(float))),
                                times(over.y, frame.place(offsetof(RayFrame, y) / sizeof(float)))),
                            times(over.z, z));
    store(along, rays.direction, k);
    hn::StoreU(hn::DemoteTo(Shorts(), zCurve(x, y)), Shorts(), rays.cell + k);
  }
}

void fill(const RayArrays& rays, const std::uint16_t* order, RTCRayHit16& packet) {
  const Floats d;
  const auto put = [&](const std::array<float*, 3>& of, std::array<float*, 3> to, Int which,
                       std::size_t k) HWY_ATTR {
    for (std::size_t c = 0; c < 3; ++c) hn::StoreU(hn::GatherIndex(d, of[c], which), d, to[c] + k);
  };
  for (std::size_t k = 0; k < kRayLanes; k += hn::Lanes(d)) {
    const Int which = hn::PromoteTo(Ints(), hn::LoadU(Shorts(), order + k));
    put(rays.origin, {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z}, which, k);
    put(rays.direction, {packet.ray.dir_x, packet.ray.dir_y, packet.ray.dir_z}, which, k);
  }
}

void find(const RTCRayHit16& packet, const RayTargets& targets, RayEnds& ends) {
  const Floats d;
  const Ints di;
  for (std::size_t k = 0; k < kRayLanes; k += hn::Lanes(d)) {
    const auto load = [&](const float* values) HWY_ATTR { return hn::LoadU(d, values + k); };
    const auto loadInts = [&](const unsigned* values) HWY_ATTR {
      return hn::LoadU(di, reinterpret_cast<const std::int32_t*>(values) + k);
    };
    const auto missed = hn::Eq(loadInts(packet.hit.geomID), set(-1));
    // A triangle's corners run counter-clockwise about the front, and Embree's normal is
    // (v1 - v0) x (v2 - v0).
    const Float along = hn::Add(hn::Add(hn::Mul(load(packet.hit.Ng_x), load(packet.ray.dir_x)),
                                        hn::Mul(load(packet.hit.Ng_y), load(packet.ray.dir_y))),
                                hn::Mul(load(packet.hit.Ng_z), load(packet.ray.dir_z)));
    const auto front = hn::RebindMask(di, hn::Lt(along, hn::Zero(d)));
    const Int side = hn::IfThenElse(front, set(0), set(1));
    const Int which = hn::Add(hn::ShiftLeft<1>(loadInts(packet.hit.primID)), side);
    const Entries target(targets.targets().data(), hn::IfThenElse(missed, hn::Zero(di), which));
    const Float s = load(packet.hit.u);
    const Float t = load(packet.hit.v);
    const auto coordinate = [&](int word) HWY_ATTR {
      const Place map = target.place(word);
      return hn::Add(hn::Add(map.x, hn::Mul(s, map.y)), hn::Mul(t, map.z));
    };
    const Float u = coordinate(offsetof(RayTarget, u) / sizeof(float));
    const Float v = coordinate(offsetof(RayTarget, v) / sizeof(float));
    const Int columns = target.whole(offsetof(RayTarget, columns) / sizeof(float));
    const Int rows = target.whole(offsetof(RayTarget, rows) / sizeof(float));
    const Int first = target.whole(offsetof(RayTarget, first) / sizeof(float));
    // Cells are centred on whole numbers.
    const auto cellAt = [&](Float x, Int cells) HWY_ATTR {
      const Int cell = hn::ConvertTo(di, hn::Add(x, set(0.5F)));
      return hn::Max(hn::Zero(di), hn::Min(cell, hn::Sub(cells, set(1))));
    };
    const Int cell = hn::Add(first, hn::Add(hn::Mul(cellAt(v, rows), columns), cellAt(u, columns)));
    const auto single = hn::Or(hn::Eq(columns, hn::Zero(di)), missed);
    Int entry = first;
    if (!hn::AllTrue(di, single)) {
      const Int inside = hn::IfThenElse(single, hn::Zero(di), cell);
      entry = hn::IfThenElse(single, first, hn::GatherIndex(di, targets.cells().data(), inside));
    }
    hn::Store(entry, di, ends.entry.data() + k);
    hn::Store(u, d, ends.u.data() + k);
    hn::Store(v, d, ends.v.data() + k);
    hn::Store(hn::BitCast(Words(), target.whole(offsetof(RayTarget, polygon) / sizeof(float))),
              Words(), ends.polygon.data() + k);
  }
}

RayKernels kernels() { return {hwy::TargetName(HWY_TARGET), scramble, toDisc, aim, fill, find}; }

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace radiosity {

HWY_EXPORT(kernels);

RayKernels rayKernels() { return HWY_DYNAMIC_DISPATCH(kernels)(); }

}  // namespace radiosity
#endif
