// Form factors from one point to many convex polygons, and to the part of each that a cone hides:
// the inner loops of the visibility of occluded pairs, behind plain pointers. One set per
// instruction set, Highway's scalar target among them; every set gives the same bits, since the
// loops only add, multiply, divide, compare and take square roots, each correctly rounded by IEEE
// 754, nothing is contracted to a fused multiply-add, and no lane's value depends on the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "radiosity/base.h"
#include "visibility/occluders/occluders.h"

namespace radiosity {

/// Arrays are filled up to a multiple of this many lanes, with copies of any polygon.
inline constexpr std::size_t kLaneAlignment = 16;
/// Corners a target may have: a quadrilateral cut by one plane.
inline constexpr std::size_t kMostCorners = 5;
/// Planes a cone may have: those with more are for VisiblePart.
inline constexpr std::size_t kMostPlanes = 128;

/// Convex polygons, one a lane, structure of arrays. A polygon's corners are given in its own plane
/// from its middle, and middles from an origin near the eye, so that rounding to T moves a polygon
/// as a whole and keeps its shape. A sum of arcs needs that: it is far smaller than the arcs.
template <class T>
struct TargetLanes {
  const T* middle[3];
  const T* axis[2][3];  ///< unit, at right angles, in the plane; first x second: out of the front
  const T* corner[kMostCorners][2];  ///< along the axes, counter-clockwise seen from the front
  std::size_t corners;  ///< 3 to kMostCorners, of every lane; polygons of fewer repeat their last
  std::size_t count;    ///< a multiple of kLaneAlignment
};

/// A point and its surface's unit normal, from the same origin.
template <class T>
struct EyePoint {
  T position[3];
  T normal[3];
};

/// Several points of one surface.
template <class T>
struct EyePoints {
  const T* position[3];
  T normal[3];
};

/// A word wide enough for a lane to add labels in.
template <class T>
using ShapeWord = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

/// Names an element of an array; a vector of them, a vector's elements.
template <class T>
using LaneIndex = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;

/// The sides of all `BlockingCone`s, one after the other: dot(normal, p) + offset >= 0 inside, p
/// from the eye. The first two belong to no cone: all is inside the one, nothing inside the other.
template <class T>
struct ConePlanes {
  static constexpr LaneIndex<T> kAllInside = 0;
  static constexpr LaneIndex<T> kNothingInside = 1;
  const T* normal[3];  ///< unit
  const T* offset;
  const ShapeWord<T>* label;  ///< scrambled: the number it adds to a shape it bounds
};

/// Polygons to clip, one a lane: targets, each seen from one of the eyes.
template <class T>
struct ClipItems {
  std::size_t count;  ///< a multiple of kLaneAlignment
  const LaneIndex<T>* target;
  const LaneIndex<T>* eye;
};

/// The part of each item inside a cone. `form_factor`: to the part inside all planes, 0 if there is
/// none, kHiddenWhole if no plane cuts the polygon. `shape`: sum of the labels of the edges that
/// bound the part, 0 if it is nothing or all. `cut_low` and `cut_high`: a bit for each plane, of
/// the first and the second 32, that cuts the polygon; the others do nothing to it. (There are no
/// bits for planes after the 64th.)
template <class T>
struct HiddenParts {
  T* form_factor;
  ShapeWord<T>* shape;
  ShapeWord<T>* cut_low;
  ShapeWord<T>* cut_high;
};

inline constexpr int kHiddenWhole = -1;

/// A distance from a plane is a sum of products of vectors rounded to T: its error may be this much
/// times the distance from the eye. A polygon that passes a plane by no more is not cut by it.
template <class T>
inline constexpr T kPlaneNoise = 4 * std::numeric_limits<T>::epsilon();

/// Directed edges in one target's plane, in its coordinates: of polygons that turn as it does, in
/// any order. Edges that two polygons side by side share cancel out.
template <class T>
struct FlatEdges {
  std::size_t count;  ///< a multiple of kLaneAlignment; filled up with edges of no length
  const T* from[2];
  const T* to[2];
};

template <class T>
struct ClipFunctions {
  /// Form factor from one eye to each polygon (all of it above the eye's horizon, its front to the
  /// eye).
  void (*whole)(const TargetLanes<T>& targets, const EyePoint<T>& eye, T* form_factor);
  /// The part of each item that one cone hides: planes [first_plane, first_plane + plane_count), 1
  /// to kMostPlanes of them.
  void (*hidden)(const TargetLanes<T>& targets, const EyePoints<T>& eyes,
                 const ConePlanes<T>& planes, const ClipItems<T>& items,
                 const LaneIndex<T>* first_plane, const LaneIndex<T>* plane_count,
                 const HiddenParts<T>& out);
  /// Form factor to the part of each item inside its own planes: own_planes[k][lane] names the
  /// lane's k-th of plane_count[lane], up to kMostPlanes. Lanes that share a vector of
  /// kLaneAlignment all have as many names as the one with most. 0 also if no plane cuts it.
  void (*common)(const TargetLanes<T>& targets, const EyePoints<T>& eyes,
                 const ConePlanes<T>& planes, const ClipItems<T>& items,
                 const LaneIndex<T>* const* own_planes, const LaneIndex<T>* plane_count,
                 T* form_factor);
  /// Form factor from one eye to the polygons bounded by `edges`, parts of one of the targets.
  T(*parts)
  (const TargetLanes<T>& targets, std::size_t target, const EyePoint<T>& eye,
   const FlatEdges<T>& edges);
};

/// Up to kLaneAlignment points, in the coordinates of an Occluder. The rest repeats one of them.
struct ConePoints {
  alignas(64) double position[3][kLaneAlignment];
  std::size_t count;
};

/// A side of a body's cones, one plane a point; see ConePlanes. The planes of points that it is no
/// side for mean nothing.
template <class T>
struct ConeSide {
  alignas(64) T normal[3][kLaneAlignment];
  alignas(64) T offset[kLaneAlignment];
  std::uint32_t points;  ///< a bit for each that it is a side for
  std::uint32_t label;   ///< the body's edge, or the number of edges plus the face
};

/// Memory that finding cones needs.
struct ConeScratch {
  double* heights;       ///< aligned; kLaneAlignment for each face of the body
  std::uint32_t* above;  ///< one for each face
};

template <class T>
struct ClipKernels {
  /// By Lambert's formula. Accuracy: 2e-6 r/h in single, 1e-14 r/h in double precision, relative to
  /// the whole, for polygons of size h at distance r; tests hold every instruction set to it.
  ClipFunctions<T> near;
  /// By the kernel cos cos / (pi r^2) to second order about the polygon's middle. Accuracy,
  /// besides: kFarError (error_model.h) times (h/r)^3, h the distance of the farthest corner from
  /// the middle.
  ClipFunctions<T> far;
  /// The sides of BlockingCone that a body has from any of the points: its edges, then, if
  /// `with_faces`, its faces. Found in double precision. Returns their number.
  std::size_t (*cones)(const Occluder& body, const ConePoints& points, bool with_faces,
                       const ConeScratch& scratch, ConeSide<T>* sides);
  /// A bit for each point whose cone has a side, through an edge of the body, with all of a polygon
  /// outside: 3 to kMostCorners corners in the body's coordinates. Edges are tried from number
  /// `edge` on, going round, until all points have one; `edge` gets the last that decided.
  std::uint32_t (*missed)(const Occluder& body, const ConePoints& points, const Vec3* outline,
                          std::size_t corners, const ConeScratch& scratch, std::size_t& edge);
};

struct ClipKernelSet {
  std::string target;  ///< instruction set, by Highway's name
  ClipKernels<float> single;
  ClipKernels<double> exact;
};

/// The best instruction set of this machine; `simd` false: Highway's scalar target, the same bits.
ClipKernelSet clipKernels(bool simd);

}  // namespace radiosity
