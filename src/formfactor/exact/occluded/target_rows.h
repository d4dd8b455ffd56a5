// Targets of a group of pairs, and the arrays in which the vector kernels read them.
#pragma once

#include <array>
#include <span>

#include "base/aligned_buffer.h"
#include "base/geometry/plane_frame.h"
#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {

/// One element as seen from a group's points.
struct GroupTarget {
  /// `outline`: counter-clockwise about the normal of `plane`, a frame in its middle.
  void setOutline(std::span<const Vec3> outline, const PlaneFrame& plane);

  std::array<Vec3, kMostCorners> corners;  ///< of the part above the points' horizon
  std::size_t corner_count = 0;
  PlaneFrame frame;                     ///< in its middle; n out of the front
  std::array<Vec2, kMostCorners> flat;  ///< corners in the frame
  std::span<const Blocker> blockers;
};

/// The arrays of TargetLanes.
template <class T>
class TargetRows {
 public:
  /// One lane a target, middles from `origin`; the rest of the last vector repeats the last
  /// target.
  void fill(std::span<const GroupTarget* const> targets, const Vec3& origin);
  /// The first `count` of other lanes once for each of `eyes`, as seen with that eye as the origin:
  /// lane eye * count + target.
  void fillFromEyes(const TargetLanes<T>& targets, std::size_t count,
                    std::span<const std::array<T, 3>> eyes);
  const TargetLanes<T>& lanes() const { return lanes_; }

 private:
  void layOut(std::size_t targets, std::size_t corners);

  AlignedBuffer<T> memory_;
  TargetLanes<T> lanes_{};
};

extern template class TargetRows<float>;
extern template class TargetRows<double>;

/// `count` rounded up to whole vectors of any instruction set.
inline std::size_t paddedLanes(std::size_t count) {
  return (count + kLaneAlignment - 1) / kLaneAlignment * kLaneAlignment;
}

}  // namespace radiosity
