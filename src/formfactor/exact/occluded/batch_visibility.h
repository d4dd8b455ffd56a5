// Visibility of many targets past many occluders from one surface point after another.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/aligned_buffer.h"
#include "formfactor/exact/occluded/batch_cones.h"
#include "formfactor/exact/occluded/cell_rule.h"
#include "formfactor/exact/occluded/target_rows.h"
#include "formfactor/exact/occluded/visible_pieces.h"
#include "visibility/clipping/clip_kernels.h"
#include "visibility/clipping/visible_part.h"

namespace radiosity {

/// Numbers from 0 for the blockers of one group, in the order they come.
class BlockerNumbers {
 public:
  void clear() { ++stamp_; }
  /// The blocker's number; `next` if it comes for the first time.
  std::uint32_t of(const Blocker& blocker, std::uint32_t next);

 private:
  struct Entry {
    std::uint32_t stamp = 0;
    std::uint32_t number = 0;
  };
  std::vector<Entry> entries_;  ///< by occluder and whether it cuts the target's plane
  std::uint32_t stamp_ = 0;
};

/// Evaluates all points of a cell against all targets of a group. Every occluder's cone is built
/// once a point; every target, seen from a point past an occluder, is a lane of the vector kernels.
/// If the shadows of two occluders fall on one target, their common part was subtracted twice.
/// Another lane corrects that: the part inside two cones is the part inside those of their planes
/// that cut the target. If more shadows fall on it, they are cut out one after the other
/// (VisiblePieces). Holds scratch memory: one a thread.
template <class T>
class BatchVisibility {
 public:
  /// The shape if nothing is visible; it is 0 if all is.
  static constexpr std::uint32_t kAllHiddenShape = 1;

  explicit BatchVisibility(const ClipKernels<T>& kernels) : kernels_(kernels), cones_(kernels) {}

  /// Looks from `points`, near `origin` on a surface of normal `normal`, at `targets`. `far`: all
  /// are far enough for the far kernels. The answers stay until the next call.
  void look(std::span<const SamplePoint> points, const Vec3& origin, const Vec3& normal,
            std::span<const GroupTarget* const> targets, bool far);

  /// Form factors from a point to all targets: to the whole target, and to its visible part.
  const T* whole(std::size_t point) const { return whole_.data() + point * targets_.lanes().count; }
  const T* visible(std::size_t point) const {
    return visible_.data() + point * targets_.lanes().count;
  }
  /// True if two shadows or more may fall on the target.
  bool overlapping(std::size_t point, std::size_t target) const {
    const std::uint8_t count = shadow_count_.data()[point * targets_.lanes().count + target];
    return count > 1 && count != kHidden;
  }
  /// See PointView.
  const ShapeWord<T>* shape(std::size_t point) const {
    return shape_.data() + point * targets_.lanes().count;
  }

 private:
  /// Shadow counts: all is hidden.
  static constexpr std::uint8_t kHidden = 255;

  /// A target has a blocker.
  struct BlockedTarget {
    const Blocker* what;
    std::uint32_t lane;
    std::uint32_t number;  ///< into group_blockers_
  };
  /// A blocker's shadow falls on part of a target that has other blockers, too.
  struct Shadow {
    std::uint32_t at;  ///< index of the value: point * lanes + lane
    std::uint32_t use;
    LaneIndex<T> first;    ///< plane of its cone
    std::uint32_t planes;  ///< that cut the target
    std::uint64_t cut;     ///< which planes of its cone cut the target
    T hidden;              ///< form factor to the part that it hides
    ShapeWord<T> shape;    ///< of that alone
  };
  /// Two shadows on one target that may overlap.
  struct Common {
    std::uint32_t first, second;  ///< into shadows_
    std::uint32_t planes;         ///< of both
  };

  void lookAtWhole();
  void collectBlockedTargets();
  void castShadows();
  void subtractHidden();
  void settleVisible();
  void uniteShadows();
  void placeCommon();
  void setLane(const Common& common, std::size_t lane, std::size_t planes);
  void evaluateCommon();
  void addCommon();
  void unite(std::span<Shadow> shadows);
  void addSides(const Shadow& shadow, std::size_t point, std::size_t lane);
  T formFactorOfPieces(std::size_t point, std::size_t lane);
  void uniteExactly(std::span<const Shadow> shadows);
  EyePoints<T> eyes() const;
  ClipItems<T> items(std::size_t count) const;

  ClipKernels<T> kernels_;
  ClipFunctions<T> clip_{};  ///< of kernels_, for this look
  std::span<const GroupTarget* const> group_;
  std::span<const SamplePoint> points_;
  Vec3 normal_{0.0};
  std::array<std::array<T, SamplePoints::kMost>, 3> eye_;
  TargetRows<T> targets_;
  TargetRows<T> from_eyes_;
  AlignedBuffer<T> whole_;    ///< by point, then target
  AlignedBuffer<T> visible_;  ///< while shadows are drawn: less than 0 where they overlap
  AlignedBuffer<ShapeWord<T>> shape_;
  AlignedBuffer<std::uint8_t> shadow_count_;
  std::vector<BlockedTarget> blocked_targets_;
  std::vector<const Blocker*> group_blockers_;
  BlockerNumbers numbers_;
  BatchCones<T> cones_;
  // Items: by point, then use. Then those of common parts.
  std::size_t item_lanes_ = 0;  ///< of common parts
  AlignedBuffer<LaneIndex<T>> item_target_;
  AlignedBuffer<LaneIndex<T>> item_eye_;
  AlignedBuffer<LaneIndex<T>> item_planes_;  ///< first plane and count; a common part's own planes
  AlignedBuffer<T> form_factor_;
  AlignedBuffer<ShapeWord<T>> word_;
  AlignedBuffer<ShapeWord<T>> cut_;  ///< low and high
  std::vector<Shadow> shadows_;
  std::vector<Common> common_;
  std::vector<std::uint32_t> common_lane_;  ///< of common_
  VisiblePieces pieces_;
  std::vector<ShadowSide> sides_;  ///< of one shadow
  AlignedBuffer<T> edges_;         ///< of pieces: four rows
  std::vector<Blocker> united_;
  VisiblePart exact_;
};

extern template class BatchVisibility<float>;
extern template class BatchVisibility<double>;

}  // namespace radiosity
