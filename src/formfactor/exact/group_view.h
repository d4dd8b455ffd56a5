// What one surface point after another sees of many targets past many occluders.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formfactor/aligned_buffer.h"
#include "formfactor/exact/clip_kernels.h"
#include "formfactor/exact/sample_cell.h"
#include "formfactor/exact/visible_part.h"

namespace radiosity {

/// One element as seen from a group's points.
struct GroupTarget {
  std::array<Vec3, kMostCorners> corners;  ///< of the part above the points' horizon
  std::size_t corner_count = 0;
  Vec3 middle{0.0};
  std::span<const Blocker> blockers;
};

/// Evaluates all points of a cell against all targets of a group: every target is a lane of the
/// vector kernels, every occluder's cone is built once a point. Where the shadows of several
/// occluders fall on one target they are united exactly, in double precision. Holds scratch
/// memory: one a thread.
template <class T>
class GroupView {
 public:
  explicit GroupView(const ClipKernels<T>& kernels) : kernels_(kernels) {}

  /// values[k] of targets[k], from the points of `cell`, whose surface's normal is `normal`.
  void look(const SampleCell& cell, const Vec3& normal, std::span<const GroupTarget* const> targets,
            std::span<CellValues> values);

 private:
  /// The arrays of TargetLanes.
  struct Lanes {
    AlignedBuffer<T> memory;
    TargetLanes<T> targets;
    void resize(std::size_t count, std::size_t corners);
    T* row(std::size_t k) { return memory.data() + k * targets.count; }
    void copyLane(std::size_t to, Lanes& from, std::size_t lane);
  };
  struct Use {
    Index blocker;
    std::uint32_t lane;
    const Blocker* what;
  };
  struct Shadow {
    std::uint32_t key;  ///< lane * kPoints + point
    const Blocker* what;
  };

  void fill(const Vec3& origin);
  void drawShadows(std::span<const Use> uses, std::span<CellValues> values);
  void hide(std::uint32_t lane, std::size_t point, std::span<CellValues> values);
  void addShadow(const Use& use, std::size_t point);
  void unite(const Vec3& normal, std::span<CellValues> values);

  ClipKernels<T> kernels_;
  std::span<const GroupTarget* const> group_;
  std::array<SampleCell::Point, SampleCell::kPoints> points_;
  std::array<EyePoint<T>, SampleCell::kPoints> eyes_;
  Vec3 origin_{0.0};
  Lanes all_;
  Lanes some_;
  AlignedBuffer<T> form_factor_;
  AlignedBuffer<ShapeWord<T>> shape_;
  std::vector<Use> uses_;
  std::vector<Shadow> shadows_;
  std::vector<std::uint8_t> shadow_count_;  ///< by key, or kHidden
  BlockingCone cone_;
  std::vector<ConePlane<T>> planes_;
  std::vector<Blocker> united_;
  VisiblePart exact_;
};

extern template class GroupView<float>;
extern template class GroupView<double>;

}  // namespace radiosity
