// The sides of a body's cones from several points at once, as blockingCone() finds them from one.
// Included once for every instruction set: Highway flips HWY_TARGET_TOGGLE in between.
#if defined(RADIOSITY_FORMFACTOR_EXACT_CONE_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RADIOSITY_FORMFACTOR_EXACT_CONE_KERNELS_INL_H
#undef RADIOSITY_FORMFACTOR_EXACT_CONE_KERNELS_INL_H
#else
#define RADIOSITY_FORMFACTOR_EXACT_CONE_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/clip_vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace radiosity::HWY_NAMESPACE {
namespace {

/// The mask's bits, lane k's as bit k.
HWY_INLINE std::uint32_t maskBits(Mask<double> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(Tag<double>(), mask, bytes);
  return bytes[0] | std::uint32_t(bytes[1]) << 8;
}

/// Stores a vector, rounded to the type it is stored as.
HWY_INLINE void storeRounded(Vector<double> v, double* to) { hn::Store(v, Tag<double>(), to); }
HWY_INLINE void storeRounded(Vector<double> v, float* to) {
  const hn::Rebind<float, Tag<double>> narrow;
  hn::Store(hn::DemoteTo(narrow, v), narrow, to);
}

HWY_INLINE Vector3<double> pointsAt(const ConePoints& points, std::size_t q) {
  const double* const from[3] = {points.position[0], points.position[1], points.position[2]};
  return load3<double>(from, q);
}

/// Heights of the points over a face. Returns a bit for each point above it.
HWY_INLINE std::uint32_t heightsOver(const Occluder::Plane& face, const ConePoints& points,
                                     double* heights) {
  const Tag<double> d;
  const Vector3<double> normal = {hn::Set(d, face.normal.x), hn::Set(d, face.normal.y),
                                  hn::Set(d, face.normal.z)};
  std::uint32_t above = 0;
  for (std::size_t q = 0; q < points.count; q += hn::Lanes(d)) {
    const auto height = hn::Sub(dot3<double>(normal, pointsAt(points, q)), hn::Set(d, face.offset));
    hn::Store(height, d, heights + q);
    above |= maskBits(hn::Gt(height, hn::Zero(d))) << q;
  }
  return above;
}

/// Stores planes, given at any length, with length 1, rounded to T.
template <class T>
HWY_INLINE void storePlanes(const Vector3<double>& normal, Vector<double> offset, std::size_t q,
                            ConeSide<T>& side) {
  const Tag<double> d;
  const auto scale = hn::Div(hn::Set(d, 1.0), hn::Sqrt(dot3<double>(normal, normal)));
  storeRounded(hn::Mul(normal.x, scale), side.normal[0] + q);
  storeRounded(hn::Mul(normal.y, scale), side.normal[1] + q);
  storeRounded(hn::Mul(normal.z, scale), side.normal[2] + q);
  storeRounded(hn::Mul(offset, scale), side.offset + q);
}

/// The planes through the points and an edge. `left`: heights over the face to its left.
template <class T>
HWY_INLINE void edgePlanes(const Vec3& from, const Vec3& to, const double* left,
                           const ConePoints& points, ConeSide<T>& side) {
  const Tag<double> d;
  const auto zero = hn::Zero(d);
  const Vec3 step = to - from;
  const Vector3<double> corner = {hn::Set(d, from.x), hn::Set(d, from.y), hn::Set(d, from.z)};
  const Vector3<double> along = {hn::Set(d, step.x), hn::Set(d, step.y), hn::Set(d, step.z)};
  for (std::size_t q = 0; q < points.count; q += hn::Lanes(d)) {
    const Vector3<double> normal = cross3<double>(sub3<double>(corner, pointsAt(points, q)), along);
    // A face turns counter-clockwise seen from outside. From there the body is to the left of the
    // edges of the faces that are seen.
    const auto seen = hn::Gt(hn::Load(d, left + q), zero);
    storePlanes<T>({hn::IfThenElse(seen, hn::Sub(zero, normal.x), normal.x),
                    hn::IfThenElse(seen, hn::Sub(zero, normal.y), normal.y),
                    hn::IfThenElse(seen, hn::Sub(zero, normal.z), normal.z)},
                   zero, q, side);
  }
}

/// Finds the points' heights over all faces, and the faces that they are above: into `scratch`.
HWY_INLINE void findFaces(const Occluder& body, const ConePoints& points,
                          const ConeScratch& scratch) {
  const std::uint32_t used = (1U << points.count) - 1;
  for (std::size_t k = 0; k < body.planes.size(); ++k) {
    double* const heights = scratch.heights + k * kLaneAlignment;
    scratch.above[k] = heightsOver(body.planes[k], points, heights) & used;
  }
}

/// A bit for each point whose plane through an edge of the body has all of a polygon on the side of
/// dot(cross(from - point, along), p) <= 0; another for the other side.
struct EdgeSides {
  std::uint32_t negative, positive;
};
HWY_INLINE EdgeSides sidesOfEdge(const Vec3& from, const Vec3& to, const Vec3* outline,
                                 std::size_t corners, const ConePoints& points) {
  const Tag<double> d;
  // In p = corner - from + (from - point) the second part drops out. There remains the product of
  // from - point with a vector that is the same for all points.
  std::array<Vec3, kMostCorners> across;
  for (std::size_t c = 0; c < corners; ++c) {
    const Vec3 a = to - from;
    const Vec3 b = outline[c] - from;
    across[c] = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  const auto zero = hn::Zero(d);
  EdgeSides bits = {0, 0};
  for (std::size_t q = 0; q < points.count; q += hn::Lanes(d)) {
    const Vector3<double> arm = sub3<double>(
        {hn::Set(d, from.x), hn::Set(d, from.y), hn::Set(d, from.z)}, pointsAt(points, q));
    auto low = zero;
    auto high = zero;
    for (std::size_t c = 0; c < corners; ++c) {
      const Vector3<double> w = {hn::Set(d, across[c].x), hn::Set(d, across[c].y),
                                 hn::Set(d, across[c].z)};
      const auto side = dot3<double>(arm, w);
      low = hn::Min(low, side);
      high = hn::Max(high, side);
    }
    bits.negative |= maskBits(hn::Ge(zero, high)) << q;
    bits.positive |= maskBits(hn::Ge(low, zero)) << q;
  }
  return bits;
}

/// See ClipKernels::missed.
inline std::uint32_t pointsThatMiss(const Occluder& body, const ConePoints& points,
                                    const Vec3* outline, std::size_t corners,
                                    const ConeScratch& scratch, std::size_t& edge) {
  findFaces(body, points, scratch);
  const std::uint32_t used = (1U << points.count) - 1;
  std::uint32_t missed = 0;
  std::size_t k = edge < body.edges.size() ? edge : 0;
  for (std::size_t n = 0; n < body.edges.size() && missed != used; ++n) {
    const Occluder::Edge& side = body.edges[k];
    const std::uint32_t seen = scratch.above[side.left];
    const std::uint32_t bounded = (seen ^ scratch.above[side.right]) & ~missed;
    if (bounded != 0) {
      const EdgeSides sides =
          sidesOfEdge(body.corners[side.from], body.corners[side.to], outline, corners, points);
      const std::uint32_t found = bounded & ((sides.negative & ~seen) | (sides.positive & seen));
      if (found != 0) edge = k;
      missed |= found;
    }
    k = k + 1 < body.edges.size() ? k + 1 : 0;
  }
  return missed;
}

template <class T>
std::size_t coneSides(const Occluder& body, const ConePoints& points, bool with_faces,
                      const ConeScratch& scratch, ConeSide<T>* sides) {
  const Tag<double> d;
  const auto heights = [&](std::size_t face) { return scratch.heights + face * kLaneAlignment; };
  findFaces(body, points, scratch);
  std::size_t count = 0;
  for (std::size_t k = 0; k < body.edges.size(); ++k) {
    const Occluder::Edge& edge = body.edges[k];
    const std::uint32_t bounded = scratch.above[edge.left] ^ scratch.above[edge.right];
    if (bounded == 0) continue;
    ConeSide<T>& side = sides[count++];
    edgePlanes<T>(body.corners[edge.from], body.corners[edge.to], heights(edge.left), points, side);
    side.points = bounded;
    side.label = std::uint32_t(k);
  }
  for (std::size_t k = 0; with_faces && k < body.planes.size(); ++k) {
    if (scratch.above[k] == 0) continue;
    ConeSide<T>& side = sides[count++];
    const Vec3& n = body.planes[k].normal;
    const Vector3<double> inward = {hn::Set(d, -n.x), hn::Set(d, -n.y), hn::Set(d, -n.z)};
    for (std::size_t q = 0; q < points.count; q += hn::Lanes(d)) {
      storePlanes<T>(inward, hn::Sub(hn::Zero(d), hn::Load(d, heights(k) + q)), q, side);
    }
    side.points = scratch.above[k];
    side.label = std::uint32_t(body.edges.size() + k);
  }
  return count;
}

}  // namespace
}  // namespace radiosity::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
