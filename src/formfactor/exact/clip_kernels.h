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
/// Planes one call may have: cones with more are for VisiblePart.
inline constexpr std::size_t kMostPlanes = 128;

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

/// Planes of every lane's own, structure of arrays; lanes of fewer are filled up with planes that
/// have everything inside, (0, 0, 0), 1.
template <class T>
struct LanePlanes {
  static constexpr std::size_t kMost = 16;
  const T* normal[kMost][3];
  const T* offset[kMost];
  std::size_t count;
};

/// What a cone leaves of each polygon. `form_factor`: to the part inside all planes, 0 where there
/// is none, kHiddenWhole where no plane cuts the polygon. `shape`: sum of the labels of the edges
/// that bound the part, 0 where it is nothing or all. `cut_low` and `cut_high`: a bit for each
/// plane, of the first and the second 32, that cuts the polygon; the others do nothing to it. (Of
/// more than 64 planes nothing is said.)
template <class T>
struct HiddenParts {
  T* form_factor;
  ShapeWord<T>* shape;
  ShapeWord<T>* cut_low;
  ShapeWord<T>* cut_high;
};

inline constexpr int kHiddenWhole = -1;

template <class T>
struct ClipKernels {
  /// Form factor to each polygon (all of it above the eye's horizon, its front to the eye).
  /// Accuracy: 2e-6 r/h in single, 1e-14 r/h in double precision, relative, for polygons of size h
  /// at distance r; tests hold every instruction set to it.
  void (*whole)(const TargetLanes<T>& targets, const EyePoint<T>& eye, T* form_factor);
  /// What one cone of at most kMostPlanes planes hides. As accurate.
  void (*hidden)(const TargetLanes<T>& targets, const EyePoint<T>& eye, const ConePlane<T>* planes,
                 std::size_t plane_count, const HiddenParts<T>& out);
  /// Form factor to the part of each polygon inside its own planes, as seen from the eye. 0 also
  /// where no plane cuts it.
  void (*common)(const TargetLanes<T>& targets, const EyePoint<T>& eye, const LanePlanes<T>& planes,
                 T* form_factor);
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
