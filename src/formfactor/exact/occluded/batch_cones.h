// The cones that a group's occluders block from each point of a cell.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned_buffer.h"
#include "formfactor/exact/occluded/cell_rule.h"
#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {

/// Scrambles a number, so that sums of several tell which they were.
std::uint32_t scrambled(std::uint32_t x);

/// Some planes of ConePlanes.
template <class T>
struct Cone {
  LaneIndex<T> first;
  LaneIndex<T> count;
  bool too_many;  ///< planes: left to VisiblePart; here, the cone has nothing inside
};

/// `BlockingCone`s in the kernels' form, of one body from all points at once.
template <class T>
class BatchCones {
 public:
  explicit BatchCones(const ClipKernels<T>& kernels) : kernels_(kernels) {}

  /// Sets the points for all that follows.
  void setPoints(std::span<const SamplePoint> points);
  /// True only if the body hides nothing of a convex polygon from any of the points.
  bool misses(const Blocker& blocker, std::span<const Vec3> outline);
  void build(std::span<const Blocker* const> blockers);
  const Cone<T>& cone(std::size_t blocker, std::size_t point) const {
    return cones_[blocker * points_.count + point];
  }
  ConePlanes<T> planes() const;

 private:
  void add(const Blocker& blocker);
  ConeScratch scratchFor(const Occluder& body);
  void resize(std::size_t planes);

  ClipKernels<T> kernels_;
  ConePoints points_;
  std::vector<Cone<T>> cones_;  ///< by blocker, then point
  std::array<std::vector<T>, 4> plane_;
  std::vector<ShapeWord<T>> label_;
  std::vector<ConeSide<T>> sides_;  ///< of one body
  AlignedBuffer<double> heights_;
  std::vector<std::uint32_t> above_;
  std::vector<std::size_t> telling_edge_;  ///< by occluder: where to look first
};

extern template class BatchCones<float>;
extern template class BatchCones<double>;

}  // namespace radiosity
