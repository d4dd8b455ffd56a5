// Form factors from one point to many convex polygons, and to what one cone hides of each: the
// inner loops of partial visibility, behind plain pointers. One set per instruction set and a
// scalar twin; every set gives the same bits, since the loops only add, multiply, divide, compare
// and take square roots, each correctly rounded by IEEE 754, nothing is contracted to a fused
// multiply-add, and no lane's value depends on the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>

#include "radiosity/base.h"

namespace radiosity {

/// Arrays are filled up to a multiple of this many lanes, with copies of any polygon.
inline constexpr std::size_t kLaneAlignment = 16;
/// Corners a target may have: a quadrilateral cut by one plane.
inline constexpr std::size_t kMostCorners = 5;
/// Planes a cone may have here: more are for VisiblePart.
inline constexpr std::size_t kMostPlanes = 24;

/// Convex polygons, one a lane, structure of arrays. A polygon's corners are given from its middle,
/// and middles from an origin near the eye, so that rounding to T moves a polygon as a whole and
/// leaves its shape: what a sum of arcs needs, which is far smaller than the arcs.
template <class T>
struct TargetLanes {
  const T* middle[3];
  const T* corner[kMostCorners][3];
  std::size_t corners;  ///< 3 to kMostCorners, of every lane; polygons of fewer repeat their last
  std::size_t count;    ///< a multiple of kLaneAlignment
};

/// A point and its surface's unit normal, from the same origin.
template <class T>
struct EyePoint {
  T position[3];
  T normal[3];
};

/// One side of a BlockingCone: dot(normal, p) + offset >= 0 inside, p from the eye.
template <class T>
struct ConePlane {
  T normal[3];  ///< unit
  T offset;
  std::uint32_t label;  ///< scrambled: what it adds to a shape it bounds
};

/// Wide enough for a lane to add labels in.
template <class T>
using ShapeWord = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

/// In `hidden` values: the cone holds the polygon whole.
inline constexpr int kHiddenWhole = -1;

template <class T>
struct ClipKernels {
  /// Form factor to each polygon (all of it above the eye's horizon, its front to the eye).
  /// Accuracy: 2e-6 r/h in single, 1e-14 r/h in double precision, relative, for polygons of size h
  /// at distance r; tests hold every instruction set to it.
  void (*whole)(const TargetLanes<T>& targets, const EyePoint<T>& eye, T* form_factor);
  /// Form factor to the part of each polygon inside all planes (at most kMostPlanes), 0 where there
  /// is none; kHiddenWhole where no plane cuts the polygon. `shape`: sum of the labels of the edges
  /// that bound the part, 0 where it is nothing or all.
  void (*hidden)(const TargetLanes<T>& targets, const EyePoint<T>& eye, const ConePlane<T>* planes,
                 std::size_t plane_count, T* form_factor, ShapeWord<T>* shape);
};

struct ClipKernelSet {
  std::string target;  ///< instruction set, or "scalar"
  ClipKernels<float> single;
  ClipKernels<double> exact;
};

/// The twin in plain C++, against which every other set is tested.
ClipKernelSet scalarClipKernels();
/// The best instruction set of this machine.
ClipKernelSet simdClipKernels();

}  // namespace radiosity
