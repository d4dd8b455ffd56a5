#include "formfactor/exact/group_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

namespace radiosity {
namespace {

/// Shadow counts: all is hidden; the largest number.
constexpr std::uint8_t kHidden = 255;
constexpr std::uint8_t kMostCounted = 254;
constexpr std::uint64_t kUnknownCut = ~std::uint64_t(0);
/// Lanes of one call for common parts: enough to fill vectors, few enough to stay in the cache.
constexpr std::size_t kCommonLanes = 128;

std::uint32_t scrambled(std::uint32_t x) {
  x = (x + 1) * 0x85ebca6bU;
  x = (x ^ (x >> 15)) * 0xc2b2ae35U;
  return x ^ (x >> 13);
}

std::size_t padded(std::size_t count) {
  return (count + kLaneAlignment - 1) / kLaneAlignment * kLaneAlignment;
}

bool sameBlocker(const Blocker& a, const Blocker& b) {
  return a.id == b.id && a.cuts_target == b.cuts_target;
}

}  // namespace

template <class T>
void GroupView<T>::Lanes::resize(std::size_t count, std::size_t corners) {
  targets.count = padded(count);
  targets.corners = corners;
  memory.reserve(targets.count * (3 + 3 * kMostCorners));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    targets.middle[axis] = row(axis);
    for (std::size_t k = 0; k < kMostCorners; ++k) targets.corner[k][axis] = row(3 + 3 * k + axis);
  }
}

template <class T>
void GroupView<T>::Lanes::copyLane(std::size_t to, Lanes& from, std::size_t lane) {
  for (std::size_t k = 0; k < 3 + 3 * targets.corners; ++k) row(k)[to] = from.row(k)[lane];
}

/// The group's targets as lanes; what is left of the last vector repeats the last target.
template <class T>
void GroupView<T>::fill(const Vec3& origin) {
  std::size_t corners = 4;
  for (const GroupTarget* target : group_) corners = std::max(corners, target->corner_count);
  all_.resize(group_.size(), corners);
  const std::size_t stride = all_.targets.count;
  for (std::size_t lane = 0; lane < stride; ++lane) {
    const GroupTarget& target = *group_[std::min(lane, group_.size() - 1)];
    T* to = all_.memory.data() + lane;
    for (int axis = 0; axis < 3; ++axis) {
      to[std::size_t(axis) * stride] = T(target.middle[axis] - origin[axis]);
    }
    for (std::size_t k = 0; k < corners; ++k) {
      const Vec3 corner = target.corners[std::min(k, target.corner_count - 1)] - target.middle;
      to += 3 * stride;
      to[0] = T(corner.x);
      to[stride] = T(corner.y);
      to[2 * stride] = T(corner.z);
    }
  }
}

template <class T>
void GroupView<T>::look(std::span<const SamplePoint> points, const Vec3& origin, const Vec3& normal,
                        std::span<const GroupTarget* const> targets) {
  group_ = targets;
  points_ = points;
  normal_ = normal;
  fill(origin);
  const std::size_t values = points.size() * all_.targets.count;
  whole_.reserve(values);
  visible_.reserve(values);
  shape_.reserve(values);
  shadow_count_.reserve(values);
  form_factor_.reserve(std::max(all_.targets.count, kCommonLanes));
  word_.reserve(all_.targets.count);
  cut_low_.reserve(all_.targets.count);
  cut_high_.reserve(all_.targets.count);
  for (std::size_t q = 0; q < points.size(); ++q) {
    for (int axis = 0; axis < 3; ++axis) {
      eyes_[q].position[axis] = T(points[q].position[axis] - origin[axis]);
      eyes_[q].normal[axis] = T(normal[axis]);
    }
    T* whole = whole_.data() + q * all_.targets.count;
    kernels_.whole(all_.targets, eyes_[q], whole);
    std::copy_n(whole, all_.targets.count, visible_.data() + q * all_.targets.count);
  }
  std::fill_n(shape_.data(), values, ShapeWord<T>(0));
  std::fill_n(shadow_count_.data(), values, std::uint8_t(0));
  sampled_.assign(targets.size(), 0);
  collectUses();
  group_blockers_.clear();
  planes_.clear();
  cone_end_.clear();
  shadows_.clear();
  for (std::size_t begin = 0; begin < uses_.size();) {
    std::size_t end = begin + 1;
    while (end < uses_.size() && sameBlocker(*uses_[end].what, *uses_[begin].what)) ++end;
    drawShadows(std::span(uses_).subspan(begin, end - begin));
    begin = end;
  }
  finish();
}

/// Who uses which blocker, by blocker.
template <class T>
void GroupView<T>::collectUses() {
  uses_.clear();
  for (std::size_t lane = 0; lane < group_.size(); ++lane) {
    for (const Blocker& blocker : group_[lane]->blockers) {
      uses_.push_back({&blocker, std::uint32_t(lane)});
    }
  }
  const auto before = [](const Use& a, const Use& b) {
    return std::tie(a.what->id, a.what->cuts_target, a.lane) <
           std::tie(b.what->id, b.what->cuts_target, b.lane);
  };
  if (!std::is_sorted(uses_.begin(), uses_.end(), before)) {
    std::sort(uses_.begin(), uses_.end(), before);
  }
}

/// Adds the sides of a blocker's cone to planes_; cone_.inside and cone_.planes tell of cones
/// without sides.
template <class T>
void GroupView<T>::addCone(const Blocker& blocker, std::size_t point) {
  blockingCone(*blocker.body, points_[point].position, blocker.cuts_target, cone_);
  for (std::size_t k = 0; k < cone_.planes.size(); ++k) {
    const ClipPlane& plane = cone_.planes[k];
    const double scale = 1 / glm::length(plane.normal);
    const Vec3 n = plane.normal * scale;
    planes_.push_back({{T(n.x), T(n.y), T(n.z)},
                       T(plane.offset * scale),
                       scrambled(blocker.id * 1024 + cone_.labels[k])});
  }
  cone_end_.push_back(std::uint32_t(planes_.size()));
}

/// What one occluder hides of the targets it concerns.
template <class T>
void GroupView<T>::drawShadows(std::span<const Use> uses) {
  if (uses.size() < group_.size()) {
    some_.resize(uses.size(), all_.targets.corners);
    for (std::size_t k = 0; k < some_.targets.count; ++k) {
      some_.copyLane(k, all_, uses[std::min(k, uses.size() - 1)].lane);
    }
  }
  group_blockers_.push_back(uses[0].what);
  for (std::size_t q = 0; q < points_.size(); ++q) drawShadow(uses, q);
}

template <class T>
void GroupView<T>::drawShadow(std::span<const Use> uses, std::size_t point) {
  const std::size_t first_plane = planes_.size();
  addCone(*uses[0].what, point);
  const std::size_t plane_count = planes_.size() - first_plane;
  const std::size_t first = point * all_.targets.count;
  std::uint8_t* counts = shadow_count_.data() + first;
  const auto number = std::uint32_t(group_blockers_.size() - 1);
  if (plane_count == 0) {
    if (!cone_.inside) return;
    for (const Use& use : uses) counts[use.lane] = kHidden;
    return;
  }
  if (plane_count > kMostPlanes) {
    for (const Use& use : uses) {
      if (counts[use.lane] != kHidden) counts[use.lane] = kMostCounted;
      shadows_.push_back({std::uint32_t(first) + use.lane, number, kUnknownCut});
    }
    return;
  }
  const bool everyone = uses.size() == group_.size();
  kernels_.hidden(everyone ? all_.targets : some_.targets, eyes_[point],
                  planes_.data() + first_plane, plane_count,
                  {form_factor_.data(), word_.data(), cut_low_.data(), cut_high_.data()});
  T* visible = visible_.data() + first;
  ShapeWord<T>* shape = shape_.data() + first;
  const T* hidden = form_factor_.data();
  for (std::size_t k = 0; k < uses.size(); ++k) {
    if (hidden[k] == 0) continue;
    const std::uint32_t lane = uses[k].lane;
    if (hidden[k] < 0) {
      counts[lane] = kHidden;
      continue;
    }
    visible[lane] -= hidden[k];
    shape[lane] += word_.data()[k];
    if (counts[lane] < kMostCounted) ++counts[lane];
    if (group_[lane]->blockers.size() > 1) {
      const std::uint64_t cut = std::uint64_t(cut_high_.data()[k]) << 32 | cut_low_.data()[k];
      shadows_.push_back(
          {std::uint32_t(first) + lane, number, plane_count <= 64 ? cut : kUnknownCut});
    }
  }
}

template <class T>
void GroupView<T>::finish() {
  uniteShadows();
  const std::size_t values = points_.size() * all_.targets.count;
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
  std::sort(shadows_.begin(), shadows_.end(), [](const Shadow& a, const Shadow& b) {
    return std::tie(a.at, a.blocker) < std::tie(b.at, b.blocker);
  });
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
    for (std::size_t k = 0; k < common_.size(); k += kCommonLanes) {
      const std::size_t count = std::min(kCommonLanes, common_.size() - k);
      evaluateCommon(std::span<const Common>(common_).subspan(k, count), sign);
    }
    joinCommon();
  }
}

/// All pairs of one target's shadows from one point. False: too many shadows or planes.
template <class T>
bool GroupView<T>::addPairs(std::uint32_t begin, std::uint32_t end) {
  if (end - begin > kMostUnited) return false;
  std::size_t planes = 0;
  for (std::uint32_t k = begin; k < end; ++k) {
    planes += std::size_t(std::popcount(shadows_[k].cut));
  }
  if (planes > LanePlanes<T>::kMost) return false;
  for (std::uint32_t a = begin; a < end; ++a) {
    for (std::uint32_t b = a + 1; b < end; ++b) common_.push_back({shadows_[a].at, 2, {a, b}});
  }
  return true;
}

/// Makes a target seen from one point, and the planes that cut it, a lane of some_.
template <class T>
void GroupView<T>::setLane(const Common& common, std::size_t lane) {
  const std::size_t point = common.at / all_.targets.count;
  some_.copyLane(lane, all_, common.at % all_.targets.count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    some_.row(axis)[lane] -= eyes_[point].position[axis];
  }
  std::size_t count = 0;
  const auto add = [&](const T* normal, T offset) {
    T* to = own_planes_.data() + 4 * count * kCommonLanes + lane;
    for (std::size_t axis = 0; axis < 3; ++axis) to[axis * kCommonLanes] = normal[axis];
    to[3 * kCommonLanes] = offset;
    ++count;
  };
  for (std::uint32_t k = 0; k < common.count; ++k) {
    const Shadow& shadow = shadows_[common.shadows[k]];
    const std::size_t cone = shadow.blocker * points_.size() + point;
    const ConePlane<T>* planes = planes_.data() + (cone > 0 ? cone_end_[cone - 1] : 0);
    for (std::uint64_t left = shadow.cut; left != 0; left &= left - 1) {
      const ConePlane<T>& plane = planes[std::countr_zero(left)];
      add(plane.normal, plane.offset);
    }
  }
  lane_planes_.count = std::max(lane_planes_.count, count);
  const T nothing[3] = {};
  for (std::size_t p = count; p < LanePlanes<T>::kMost; ++p) add(nothing, 1);
}

/// Adds (or takes away) what is inside all of some cones, and keeps in next_common_ those where
/// that is anything.
template <class T>
void GroupView<T>::evaluateCommon(std::span<const Common> some, T sign) {
  some_.resize(some.size(), all_.targets.corners);
  own_planes_.reserve(4 * LanePlanes<T>::kMost * kCommonLanes);
  lane_planes_.count = 0;
  for (std::size_t p = 0; p < LanePlanes<T>::kMost; ++p) {
    const T* row = own_planes_.data() + 4 * p * kCommonLanes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lane_planes_.normal[p][axis] = row + axis * kCommonLanes;
    }
    lane_planes_.offset[p] = row + 3 * kCommonLanes;
  }
  for (std::size_t k = 0; k < some_.targets.count; ++k) {
    setLane(some[std::min(k, some.size() - 1)], k);
  }
  // Lanes are given from their own eyes.
  EyePoint<T> eye = eyes_[0];
  for (T& coordinate : eye.position) coordinate = 0;
  kernels_.common(some_.targets, eye, lane_planes_, form_factor_.data());
  for (std::size_t k = 0; k < some.size(); ++k) {
    const T common = form_factor_.data()[k];
    if (!(common > 0)) continue;
    visible_.data()[some[k].at] += sign * common;
    shape_.data()[some[k].at] += scrambled(some[k].count);
    next_common_.push_back(some[k]);
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
      common_.push_back(joined);
    }
  }
  next_common_.clear();
}

/// One target's shadows from one point, in double precision.
template <class T>
void GroupView<T>::uniteExactly(std::span<const Shadow> shadows) {
  const std::size_t at = shadows[0].at;
  const std::size_t point = at / all_.targets.count;
  const std::size_t lane = at % all_.targets.count;
  const GroupTarget& target = *group_[lane];
  united_.clear();
  for (const Shadow& shadow : shadows) united_.push_back(*group_blockers_[shadow.blocker]);
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
