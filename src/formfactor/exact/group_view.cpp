#include "formfactor/exact/group_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace radiosity {
namespace {

/// Shadow counts: all is hidden; the largest number.
constexpr std::uint8_t kHidden = 255;
constexpr std::uint8_t kMostCounted = 254;
constexpr std::uint64_t kUnknownCut = ~std::uint64_t(0);
/// Planes that may bound what shadows have in common.
constexpr std::size_t kMostOwnPlanes = 16;

}  // namespace

std::uint32_t BlockerNumbers::of(const Blocker& blocker, std::uint32_t next) {
  const std::size_t at = 2 * std::size_t(blocker.id) + (blocker.cuts_target ? 1 : 0);
  if (at >= entries_.size()) entries_.resize(at + 1);
  Entry& entry = entries_[at];
  if (entry.stamp != stamp_) entry = {stamp_, next};
  return entry.number;
}

template <class T>
void GroupView<T>::look(std::span<const SamplePoint> points, const Vec3& origin, const Vec3& normal,
                        std::span<const GroupTarget* const> targets, bool far) {
  clip_ = far ? kernels_.far : kernels_.near;
  group_ = targets;
  points_ = points;
  normal_ = normal;
  targets_.fill(targets, origin);
  const std::size_t stride = targets_.lanes().count;
  const std::size_t values = points.size() * stride;
  whole_.reserve(values);
  visible_.reserve(values);
  shape_.reserve(values);
  shadow_count_.reserve(values);
  EyePoint<T> eye;
  for (int axis = 0; axis < 3; ++axis) eye.normal[axis] = T(normal[axis]);
  for (std::size_t q = 0; q < points.size(); ++q) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = glm::length_t(axis);
      eye.position[axis] = eye_[axis][q] = T(points[q].position[a] - origin[a]);
    }
    clip_.whole(targets_.lanes(), eye, whole_.data() + q * stride);
  }
  std::copy_n(whole_.data(), values, visible_.data());
  std::fill_n(shape_.data(), values, ShapeWord<T>(0));
  std::fill_n(shadow_count_.data(), values, std::uint8_t(0));
  sampled_.assign(targets.size(), 0);
  collectUses();
  cones_.build(points_, group_blockers_);
  hide();
  subtractHidden();
  finish();
}

/// Who uses which blocker, by target.
template <class T>
void GroupView<T>::collectUses() {
  uses_.clear();
  group_blockers_.clear();
  numbers_.clear();
  for (std::size_t lane = 0; lane < group_.size(); ++lane) {
    for (const Blocker& blocker : group_[lane]->blockers) {
      const auto next = std::uint32_t(group_blockers_.size());
      const std::uint32_t number = numbers_.of(blocker, next);
      if (number == next) group_blockers_.push_back(&blocker);
      uses_.push_back({&blocker, std::uint32_t(lane), number});
    }
  }
}

template <class T>
EyePoints<T> GroupView<T>::eyes() const {
  return {{eye_[0].data(), eye_[1].data(), eye_[2].data()},
          {T(normal_.x), T(normal_.y), T(normal_.z)}};
}

template <class T>
ClipItems<T> GroupView<T>::items(std::size_t count) const {
  return {count, item_target_.data(), item_eye_.data()};
}

/// What each occluder hides of each target it concerns, from each point: into form_factor_.
template <class T>
void GroupView<T>::hide() {
  const std::size_t count = points_.size() * uses_.size();
  if (count == 0) return;
  const std::size_t lanes = paddedLanes(count);
  item_target_.reserve(lanes);
  item_eye_.reserve(lanes);
  item_planes_.reserve(2 * lanes);
  form_factor_.reserve(lanes);
  word_.reserve(lanes);
  cut_.reserve(2 * lanes);
  LaneIndex<T>* first = item_planes_.data();
  LaneIndex<T>* plane_count = first + lanes;
  std::size_t at = 0;
  const auto add = [&](const Use& use, std::size_t point) {
    const Cone<T>& cone = cones_.cone(use.number, point);
    item_target_.data()[at] = LaneIndex<T>(use.lane);
    item_eye_.data()[at] = LaneIndex<T>(point);
    first[at] = cone.first;
    plane_count[at++] = cone.count;
  };
  for (std::size_t q = 0; q < points_.size(); ++q) {
    for (const Use& use : uses_) add(use, q);
  }
  for (std::size_t left = lanes - count; left > 0; --left) add(uses_.back(), points_.size() - 1);
  clip_.hidden(targets_.lanes(), eyes(), cones_.planes(), items(lanes), first, plane_count,
               {form_factor_.data(), word_.data(), cut_.data(), cut_.data() + lanes});
}

/// Takes away what is hidden, as if no two shadows overlapped.
template <class T>
void GroupView<T>::subtractHidden() {
  shadows_.clear();
  const std::size_t lanes = paddedLanes(points_.size() * uses_.size());
  std::size_t item = 0;
  for (std::size_t q = 0; q < points_.size(); ++q) {
    const std::size_t row = q * targets_.lanes().count;
    for (std::uint32_t u = 0; u < uses_.size(); ++u, ++item) {
      const T hidden = form_factor_.data()[item];
      const Cone<T>& cone = cones_.cone(uses_[u].number, q);
      if (hidden == 0 && !cone.too_many) continue;
      const std::size_t at = row + uses_[u].lane;
      std::uint8_t& count = shadow_count_.data()[at];
      if (hidden < 0) count = kHidden;
      if (count == kHidden) continue;
      if (cone.too_many) {
        count = kMostCounted;
        shadows_.push_back({std::uint32_t(at), u, cone.first, 64, kUnknownCut});
        continue;
      }
      visible_.data()[at] -= hidden;
      shape_.data()[at] += word_.data()[item];
      if (count < kMostCounted) ++count;
      if (group_[uses_[u].lane]->blockers.size() > 1) {
        const std::uint64_t low = cut_.data()[item];
        const std::uint64_t high = cut_.data()[lanes + item];
        const std::uint64_t cut = cone.count <= 64 ? high << 32 | low : kUnknownCut;
        shadows_.push_back(
            {std::uint32_t(at), u, cone.first, std::uint32_t(std::popcount(cut)), cut});
      }
    }
  }
}

template <class T>
void GroupView<T>::finish() {
  uniteShadows();
  const std::size_t values = points_.size() * targets_.lanes().count;
  for (std::size_t at = 0; at < values; ++at) {
    // A difference of rounded sums: kept from passing zero by its last digits.
    visible_.data()[at] = std::max(visible_.data()[at], T(0));
    if (shadow_count_.data()[at] != kHidden) continue;
    visible_.data()[at] = 0;
    shape_.data()[at] = kAllHiddenShape;
  }
}

/// Puts right what was subtracted more than once.
template <class T>
void GroupView<T>::uniteShadows() {
  const auto alone = [&](const Shadow& s) {
    const std::uint8_t count = shadow_count_.data()[s.at];
    return count < 2 || count == kHidden;
  };
  std::erase_if(shadows_, alone);
  common_.clear();
  for (std::uint32_t begin = 0; begin < shadows_.size();) {
    std::uint32_t end = begin + 1;
    while (end < shadows_.size() && shadows_[end].at == shadows_[begin].at) ++end;
    if (!addPairs(begin, end)) {
      uniteExactly(std::span<const Shadow>(shadows_).subspan(begin, end - begin));
    }
    begin = end;
  }
  for (T sign = 1; !common_.empty(); sign = -sign) {
    evaluateCommon();
    addCommon(sign);
    joinCommon();
  }
}

/// All pairs of one target's shadows from one point. False: too many shadows or planes.
template <class T>
bool GroupView<T>::addPairs(std::uint32_t begin, std::uint32_t end) {
  if (end - begin > kMostUnited) return false;
  std::size_t planes = 0;
  for (std::uint32_t k = begin; k < end; ++k) planes += shadows_[k].planes;
  if (planes > kMostOwnPlanes) return false;
  for (std::uint32_t a = begin; a < end; ++a) {
    for (std::uint32_t b = a + 1; b < end; ++b) {
      common_.push_back({shadows_[a].at, 2, shadows_[a].planes + shadows_[b].planes, {a, b}});
    }
  }
  return true;
}

/// A lane for each of common_, by the number of planes, so that vectors are alike.
template <class T>
void GroupView<T>::placeCommon() {
  std::array<std::uint32_t, kMostOwnPlanes + 2> begin = {};
  for (const Common& common : common_) ++begin[common.planes + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  common_lane_.clear();
  for (const Common& common : common_) common_lane_.push_back(begin[common.planes]++);
}

/// Makes a set of shadows a lane; `planes`: how many it has to name.
template <class T>
void GroupView<T>::setLane(const Common& common, std::size_t lane, std::size_t planes) {
  const std::size_t stride = targets_.lanes().count;
  item_target_.data()[lane] = LaneIndex<T>(common.at % stride);
  item_eye_.data()[lane] = LaneIndex<T>(common.at / stride);
  LaneIndex<T>* to = item_planes_.data() + lane;
  const auto add = [&](LaneIndex<T> plane) {
    *to = plane;
    to += item_lanes_;
  };
  for (std::uint32_t k = 0; k < common.count; ++k) {
    const Shadow& shadow = shadows_[common.shadows[k]];
    for (std::uint64_t left = shadow.cut; left != 0; left &= left - 1) {
      add(shadow.first + std::countr_zero(left));
    }
  }
  for (std::size_t p = common.planes; p < planes; ++p) add(ConePlanes<T>::kAllInside);
}

/// What is inside all of some cones, for all of common_: into form_factor_, by lane.
template <class T>
void GroupView<T>::evaluateCommon() {
  placeCommon();
  item_lanes_ = paddedLanes(common_.size());
  item_target_.reserve(item_lanes_);
  item_eye_.reserve(item_lanes_);
  item_planes_.reserve((kMostOwnPlanes + 1) * item_lanes_);
  form_factor_.reserve(item_lanes_);
  LaneIndex<T>* const plane_count = item_planes_.data() + kMostOwnPlanes * item_lanes_;
  for (std::size_t k = 0; k < common_.size(); ++k) {
    plane_count[common_lane_[k]] = LaneIndex<T>(common_[k].planes);
  }
  // The rest of the last vector repeats a lane of most planes.
  std::fill(plane_count + common_.size(), plane_count + item_lanes_,
            plane_count[common_.size() - 1]);
  for (std::size_t k = 0; k < common_.size(); ++k) {
    const std::size_t lane = common_lane_[k];
    const auto planes = std::size_t(plane_count[lane | (kLaneAlignment - 1)]);
    setLane(common_[k], lane, planes);
    if (lane + 1 < common_.size()) continue;
    for (std::size_t more = lane + 1; more < item_lanes_; ++more) {
      setLane(common_[k], more, planes);
    }
  }
  std::array<const LaneIndex<T>*, kMostOwnPlanes> own_planes;
  for (std::size_t p = 0; p < kMostOwnPlanes; ++p) {
    own_planes[p] = item_planes_.data() + p * item_lanes_;
  }
  clip_.common(targets_.lanes(), eyes(), cones_.planes(), items(item_lanes_), own_planes.data(),
               plane_count, form_factor_.data());
}

/// Adds (or takes away) what was evaluated, and keeps in next_common_ the sets where that is
/// anything.
template <class T>
void GroupView<T>::addCommon(T sign) {
  for (std::size_t k = 0; k < common_.size(); ++k) {
    const T common = form_factor_.data()[common_lane_[k]];
    if (!(common > 0)) continue;
    visible_.data()[common_[k].at] += sign * common;
    shape_.data()[common_[k].at] += scrambled(common_[k].count);
    next_common_.push_back(common_[k]);
  }
}

/// From sets of n shadows that have something in common, those of n + 1 that may have: two sets
/// that differ in their last member only make one. Sets come in ascending order and stay so.
template <class T>
void GroupView<T>::joinCommon() {
  common_.clear();
  for (std::size_t a = 0; a < next_common_.size(); ++a) {
    const Common& first = next_common_[a];
    const std::uint32_t last = first.count - 1;
    for (std::size_t b = a + 1; b < next_common_.size(); ++b) {
      const Common& second = next_common_[b];
      const bool same =
          second.at == first.at &&
          std::equal(first.shadows.begin(), first.shadows.begin() + last, second.shadows.begin());
      if (!same) break;
      Common joined = first;
      joined.shadows[joined.count++] = second.shadows[last];
      joined.planes += shadows_[second.shadows[last]].planes;
      common_.push_back(joined);
    }
  }
  next_common_.clear();
}

/// One target's shadows from one point, in double precision.
template <class T>
void GroupView<T>::uniteExactly(std::span<const Shadow> shadows) {
  const std::size_t at = shadows[0].at;
  const std::size_t point = at / targets_.lanes().count;
  const std::size_t lane = at % targets_.lanes().count;
  const GroupTarget& target = *group_[lane];
  united_.clear();
  for (const Shadow& shadow : shadows) united_.push_back(*uses_[shadow.use].what);
  // Shifts of a rank-one lattice (Roberts 2018): where pictures are drawn, those of a cell's
  // points fill each other's gaps.
  const double q = double(point);
  const Vec2 shift(std::fmod(0.5 + 0.75487766624669276 * q, 1.0),
                   std::fmod(0.5 + 0.56984029099805327 * q, 1.0));
  const PointView view =
      exact_.look(points_[point].position, normal_,
                  std::span(target.corners).first(target.corner_count), united_, shift);
  const double fraction = view.whole > 0 ? view.visible / view.whole : 0;
  visible_.data()[at] = T(fraction * double(whole_.data()[at]));
  shape_.data()[at] = ShapeWord<T>(view.shape);
  sampled_[lane] |= std::uint8_t(view.sampled);
}

template class GroupView<float>;
template class GroupView<double>;

}  // namespace radiosity
