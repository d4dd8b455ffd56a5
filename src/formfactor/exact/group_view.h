// What one surface point after another sees of many targets past many occluders.
#pragma once

#include <array>
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
/// occluders fall on one target, what they have in common was subtracted more than once; that is
/// put right by inclusion and exclusion: the part inside several cones is the part inside those of
/// their planes that cut the target. Shadows that share nothing end the expansion early. Where
/// there are too many, VisiblePart unites them. Holds scratch memory: one a thread.
template <class T>
class GroupView {
 public:
  /// Shadows on one target that are united by inclusion and exclusion.
  static constexpr std::size_t kMostUnited = 6;
  /// The shape where nothing is visible; where all is, it is 0.
  static constexpr std::uint32_t kAllHiddenShape = 1;

  explicit GroupView(const ClipKernels<T>& kernels) : kernels_(kernels) {}

  /// Looks from `points`, near `origin` on a surface of normal `normal`, at `targets`. The answers
  /// stay until the next call.
  void look(std::span<const SamplePoint> points, const Vec3& origin, const Vec3& normal,
            std::span<const GroupTarget* const> targets);

  /// From a point, of all targets: form factors, visible from 0 to whole.
  const T* whole(std::size_t point) const { return whole_.data() + point * all_.targets.count; }
  const T* visible(std::size_t point) const { return visible_.data() + point * all_.targets.count; }
  /// See PointView.
  const ShapeWord<T>* shape(std::size_t point) const {
    return shape_.data() + point * all_.targets.count;
  }
  /// Some point saw too many shadows on this target: see Coverage.
  bool sampled(std::size_t target) const { return sampled_[target] != 0; }

 private:
  /// The arrays of TargetLanes.
  struct Lanes {
    AlignedBuffer<T> memory;
    TargetLanes<T> targets;
    void resize(std::size_t count, std::size_t corners);
    T* row(std::size_t k) { return memory.data() + k * targets.count; }
    void copyLane(std::size_t to, Lanes& from, std::size_t lane);
  };
  /// Target `lane` has a blocker.
  struct Use {
    const Blocker* what;
    std::uint32_t lane;
  };
  /// A blocker's shadow falls on part of a target that has other blockers, too.
  struct Shadow {
    std::uint32_t at;       ///< index of the value: point * lanes + lane
    std::uint32_t blocker;  ///< into group_blockers_
    std::uint64_t cut;      ///< which planes of its cone cut the target
  };
  /// What several shadows on one target may have in common.
  struct Common {
    std::uint32_t at;
    std::uint32_t count;
    std::array<std::uint32_t, kMostUnited> shadows;  ///< into shadows_, ascending; first `count`
  };

  void fill(const Vec3& origin);
  void collectUses();
  void drawShadows(std::span<const Use> uses);
  void drawShadow(std::span<const Use> uses, std::size_t point);
  void addCone(const Blocker& blocker, std::size_t point);
  void finish();
  void uniteShadows();
  bool addPairs(std::uint32_t begin, std::uint32_t end);
  void evaluateCommon(std::span<const Common> some, T sign);
  void setLane(const Common& common, std::size_t lane);
  void joinCommon();
  void uniteExactly(std::span<const Shadow> shadows);

  ClipKernels<T> kernels_;
  std::span<const GroupTarget* const> group_;
  std::span<const SamplePoint> points_;
  Vec3 normal_{0.0};
  std::array<EyePoint<T>, SamplePoints::kMost> eyes_;
  Lanes all_;
  Lanes some_;
  AlignedBuffer<T> whole_;    ///< by point, then target
  AlignedBuffer<T> visible_;  ///< while shadows are drawn: less than 0 where they overlap
  AlignedBuffer<ShapeWord<T>> shape_;
  AlignedBuffer<std::uint8_t> shadow_count_;
  AlignedBuffer<T> form_factor_;  ///< of one kernel call
  AlignedBuffer<ShapeWord<T>> word_;
  AlignedBuffer<ShapeWord<T>> cut_low_;
  AlignedBuffer<ShapeWord<T>> cut_high_;
  std::vector<std::uint8_t> sampled_;
  std::vector<Use> uses_;
  std::vector<const Blocker*> group_blockers_;
  std::vector<ConePlane<T>> planes_;     ///< of all cones
  std::vector<std::uint32_t> cone_end_;  ///< by blocker, then point: into planes_
  std::vector<Shadow> shadows_;
  std::vector<Common> common_;
  std::vector<Common> next_common_;
  AlignedBuffer<T> own_planes_;
  LanePlanes<T> lane_planes_;
  BlockingCone cone_;
  std::vector<Blocker> united_;
  VisiblePart exact_;
};

extern template class GroupView<float>;
extern template class GroupView<double>;

}  // namespace radiosity
