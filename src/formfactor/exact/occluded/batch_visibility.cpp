#include "formfactor/exact/occluded/batch_visibility.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace radiosity {
namespace {

/// Counts of shadows on a target end at this number.
constexpr std::uint8_t kMostCounted = 254;
constexpr std::uint64_t kUnknownCut = ~std::uint64_t(0);
/// Added to the shape where shadows overlap.
constexpr std::uint32_t kOverlap = 0x9e3779b9U;
/// Planes that may bound the common part of two shadows.
constexpr std::size_t kMostOwnPlanes = 16;

/// With up to this many targets, cones are not built before they are known to meet one: from a
/// small part of an element, most occluders of the whole miss the target. More targets share cones.
constexpr std::size_t kFewTargets = 4;

/// Up to this many targets leave most of a vector empty.
constexpr std::size_t kFewLanes = 8;

}  // namespace

std::uint32_t BlockerNumbers::of(const Blocker& blocker, std::uint32_t next) {
  const std::size_t at = 2 * std::size_t(blocker.id) + (blocker.cuts_target ? 1 : 0);
  if (at >= entries_.size()) entries_.resize(at + 1);
  Entry& entry = entries_[at];
  if (entry.stamp != stamp_) entry = {stamp_, next};
  return entry.number;
}

template <class T>
void BatchVisibility<T>::look(std::span<const SamplePoint> points, const Vec3& origin,
                              const Vec3& normal, std::span<const GroupTarget* const> targets,
                              bool far) {
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
  for (std::size_t q = 0; q < points.size(); ++q) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = glm::length_t(axis);
      eye_[axis][q] = T(points[q].position[a] - origin[a]);
    }
  }
  lookAtWhole();
  std::copy_n(whole_.data(), values, visible_.data());
  std::fill_n(shape_.data(), values, ShapeWord<T>(0));
  std::fill_n(shadow_count_.data(), values, std::uint8_t(0));
  cones_.setPoints(points_);
  collectBlockedTargets();
  cones_.build(group_blockers_);
  castShadows();
  subtractHidden();
  settleVisible();
}

/// Computes form factors with nothing in between. Few targets share vectors from all points, with
/// the same bits: kernels use only the difference of an eye and a target.
template <class T>
void BatchVisibility<T>::lookAtWhole() {
  const std::size_t stride = targets_.lanes().count;
  EyePoint<T> eye{};
  for (int axis = 0; axis < 3; ++axis) eye.normal[axis] = T(normal_[axis]);
  std::array<std::array<T, 3>, SamplePoints::kMost> eyes;
  for (std::size_t q = 0; q < points_.size(); ++q) {
    eyes[q] = {eye_[0][q], eye_[1][q], eye_[2][q]};
  }
  if (group_.size() > kFewLanes) {
    for (std::size_t q = 0; q < points_.size(); ++q) {
      std::copy(eyes[q].begin(), eyes[q].end(), std::begin(eye.position));
      clip_.whole(targets_.lanes(), eye, whole_.data() + q * stride);
    }
    return;
  }
  from_eyes_.fillFromEyes(targets_.lanes(), group_.size(), std::span(eyes).first(points_.size()));
  form_factor_.reserve(from_eyes_.lanes().count);
  clip_.whole(from_eyes_.lanes(), eye, form_factor_.data());
  for (std::size_t q = 0; q < points_.size(); ++q) {
    const T* const found = form_factor_.data() + q * group_.size();
    std::copy_n(found, group_.size(), whole_.data() + q * stride);
    std::fill(whole_.data() + q * stride + group_.size(), whole_.data() + (q + 1) * stride,
              found[group_.size() - 1]);
  }
}

/// Collects the blockers that each target uses, by target.
template <class T>
void BatchVisibility<T>::collectBlockedTargets() {
  blocked_targets_.clear();
  group_blockers_.clear();
  numbers_.clear();
  for (std::size_t lane = 0; lane < group_.size(); ++lane) {
    const GroupTarget& target = *group_[lane];
    const auto outline = std::span(target.corners).first(target.corner_count);
    for (const Blocker& blocker : target.blockers) {
      const std::size_t most_planes = blocker.body->edges.size() + blocker.body->planes.size();
      // A body with too many planes for the kernels is dear in any group.
      const bool look_first = group_.size() <= kFewTargets || most_planes > kMostPlanes;
      if (look_first && cones_.misses(blocker, outline)) continue;
      const auto next = std::uint32_t(group_blockers_.size());
      const std::uint32_t number = numbers_.of(blocker, next);
      if (number == next) group_blockers_.push_back(&blocker);
      blocked_targets_.push_back({&blocker, std::uint32_t(lane), number});
    }
  }
}

template <class T>
EyePoints<T> BatchVisibility<T>::eyes() const {
  return {{eye_[0].data(), eye_[1].data(), eye_[2].data()},
          {T(normal_.x), T(normal_.y), T(normal_.z)}};
}

template <class T>
ClipItems<T> BatchVisibility<T>::items(std::size_t count) const {
  return {count, item_target_.data(), item_eye_.data()};
}

/// Finds the part that each occluder hides of each target it concerns, from each point: into
/// form_factor_.
template <class T>
void BatchVisibility<T>::castShadows() {
  const std::size_t count = points_.size() * blocked_targets_.size();
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
  const auto add = [&](const BlockedTarget& use, std::size_t point) {
    const Cone<T>& cone = cones_.cone(use.number, point);
    item_target_.data()[at] = LaneIndex<T>(use.lane);
    item_eye_.data()[at] = LaneIndex<T>(point);
    first[at] = cone.first;
    plane_count[at++] = cone.count;
  };
  for (std::size_t q = 0; q < points_.size(); ++q) {
    for (const BlockedTarget& use : blocked_targets_) add(use, q);
  }
  for (std::size_t left = lanes - count; left > 0; --left)
    add(blocked_targets_.back(), points_.size() - 1);
  clip_.hidden(targets_.lanes(), eyes(), cones_.planes(), items(lanes), first, plane_count,
               {form_factor_.data(), word_.data(), cut_.data(), cut_.data() + lanes});
}

/// Subtracts the hidden parts, as if no two shadows overlapped.
template <class T>
void BatchVisibility<T>::subtractHidden() {
  shadows_.clear();
  const std::size_t lanes = paddedLanes(points_.size() * blocked_targets_.size());
  std::size_t item = 0;
  for (std::size_t q = 0; q < points_.size(); ++q) {
    const std::size_t row = q * targets_.lanes().count;
    for (std::uint32_t u = 0; u < blocked_targets_.size(); ++u, ++item) {
      const T hidden = form_factor_.data()[item];
      const Cone<T>& cone = cones_.cone(blocked_targets_[u].number, q);
      if (hidden == 0 && !cone.too_many) continue;
      const std::size_t at = row + blocked_targets_[u].lane;
      std::uint8_t& count = shadow_count_.data()[at];
      if (hidden < 0) count = kHidden;
      if (count == kHidden) continue;
      if (cone.too_many) {
        count = kMostCounted;
        shadows_.push_back({std::uint32_t(at), u, cone.first, 64, kUnknownCut, hidden, 0});
        continue;
      }
      visible_.data()[at] -= hidden;
      shape_.data()[at] += word_.data()[item];
      if (count < kMostCounted) ++count;
      if (group_[blocked_targets_[u].lane]->blockers.size() > 1) {
        const std::uint64_t low = cut_.data()[item];
        const std::uint64_t high = cut_.data()[lanes + item];
        const std::uint64_t cut = cone.count <= 64 ? high << 32 | low : kUnknownCut;
        shadows_.push_back({std::uint32_t(at), u, cone.first, std::uint32_t(std::popcount(cut)),
                            cut, hidden, word_.data()[item]});
      }
    }
  }
}

template <class T>
void BatchVisibility<T>::settleVisible() {
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

/// Corrects for parts that were subtracted more than once.
template <class T>
void BatchVisibility<T>::uniteShadows() {
  const auto alone = [&](const Shadow& s) {
    const std::uint8_t count = shadow_count_.data()[s.at];
    return count < 2 || count == kHidden;
  };
  std::erase_if(shadows_, alone);
  common_.clear();
  for (std::uint32_t begin = 0; begin < shadows_.size();) {
    std::uint32_t end = begin + 1;
    while (end < shadows_.size() && shadows_[end].at == shadows_[begin].at) ++end;
    const std::uint32_t planes = shadows_[begin].planes + shadows_[end - 1].planes;
    if (end - begin == 2 && planes <= kMostOwnPlanes) {
      common_.push_back({begin, begin + 1, planes});
    } else {
      unite(std::span<Shadow>(shadows_).subspan(begin, end - begin));
    }
    begin = end;
  }
  if (common_.empty()) return;
  evaluateCommon();
  addCommon();
}

/// A lane for each of common_, by the number of planes, so that vectors are alike.
template <class T>
void BatchVisibility<T>::placeCommon() {
  std::array<std::uint32_t, kMostOwnPlanes + 2> begin = {};
  for (const Common& common : common_) ++begin[common.planes + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  common_lane_.clear();
  for (const Common& common : common_) common_lane_.push_back(begin[common.planes]++);
}

/// Fills a lane with the common part of two shadows; `planes`: how many it has to name.
template <class T>
void BatchVisibility<T>::setLane(const Common& common, std::size_t lane, std::size_t planes) {
  const std::size_t stride = targets_.lanes().count;
  const std::uint32_t at = shadows_[common.first].at;
  item_target_.data()[lane] = LaneIndex<T>(at % stride);
  item_eye_.data()[lane] = LaneIndex<T>(at / stride);
  LaneIndex<T>* to = item_planes_.data() + lane;
  const auto add = [&](LaneIndex<T> plane) {
    *to = plane;
    to += item_lanes_;
  };
  for (const std::uint32_t k : {common.first, common.second}) {
    const Shadow& shadow = shadows_[k];
    for (std::uint64_t left = shadow.cut; left != 0; left &= left - 1) {
      add(shadow.first + std::countr_zero(left));
    }
  }
  for (std::size_t p = common.planes; p < planes; ++p) add(ConePlanes<T>::kAllInside);
}

/// Form factors to the parts inside two cones, for all of common_: into form_factor_, by lane.
template <class T>
void BatchVisibility<T>::evaluateCommon() {
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

/// Adds the common parts, which were subtracted twice.
template <class T>
void BatchVisibility<T>::addCommon() {
  for (std::size_t k = 0; k < common_.size(); ++k) {
    const T common = form_factor_.data()[common_lane_[k]];
    if (!(common > 0)) continue;
    const std::uint32_t at = shadows_[common_[k].first].at;
    visible_.data()[at] += common;
    shape_.data()[at] += kOverlap;
  }
}

/// The lines in a target's plane that bound a shadow on it, as the kernels find them: into sides_.
template <class T>
void BatchVisibility<T>::addSides(const Shadow& shadow, std::size_t point, std::size_t lane) {
  const TargetLanes<T>& target = targets_.lanes();
  const ConePlanes<T> cones = cones_.planes();
  sides_.clear();
  const auto add = [&](LaneIndex<T> plane) {
    ShadowSide side{0, 0, double(cones.offset[plane])};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto n = double(cones.normal[axis][plane]);
      side.a += n * double(target.axis[0][axis][lane]);
      side.b += n * double(target.axis[1][axis][lane]);
      side.c += n * (double(target.middle[axis][lane]) - double(eye_[axis][point]));
    }
    sides_.push_back(side);
  };
  if (shadow.cut != kUnknownCut) {
    for (std::uint64_t left = shadow.cut; left != 0; left &= left - 1) {
      add(shadow.first + std::countr_zero(left));
    }
    return;
  }
  const Cone<T>& cone = cones_.cone(blocked_targets_[shadow.use].number, point);
  for (LaneIndex<T> k = 0; k < cone.count; ++k) add(cone.first + k);
}

/// One target's shadows from one point, the largest cut out first.
template <class T>
void BatchVisibility<T>::unite(std::span<Shadow> shadows) {
  const std::size_t at = shadows[0].at;
  const std::size_t point = at / targets_.lanes().count;
  const std::size_t lane = at % targets_.lanes().count;
  const auto too_many = [&](const Shadow& s) {
    return cones_.cone(blocked_targets_[s.use].number, point).too_many;
  };
  if (std::any_of(shadows.begin(), shadows.end(), too_many)) {
    uniteExactly(shadows);
    return;
  }
  std::sort(shadows.begin(), shadows.end(), [&](const Shadow& a, const Shadow& b) {
    if (a.hidden != b.hidden) return a.hidden > b.hidden;
    return blocked_targets_[a.use].what->id < blocked_targets_[b.use].what->id;
  });
  const GroupTarget& target = *group_[lane];
  const double noise = kPlaneNoise<T> * glm::distance(points_[point].position, target.frame.origin);
  pieces_.begin(std::span(target.flat).first(target.corner_count));
  // A shadow that lies wholly on others bounds nothing.
  ShapeWord<T> shape = 0;
  for (const Shadow& shadow : shadows) {
    addSides(shadow, point, lane);
    if (!pieces_.subtract(sides_, noise)) continue;
    shape += shadow.shape;
    if (!pieces_.empty()) continue;
    shadow_count_.data()[at] = kHidden;
    return;
  }
  shape_.data()[at] = shape;
  visible_.data()[at] = std::min(formFactorOfPieces(point, lane), whole_.data()[at]);
}

/// Form factor from a point to the part of a target that pieces_ hold.
template <class T>
T BatchVisibility<T>::formFactorOfPieces(std::size_t point, std::size_t lane) {
  std::size_t count = 0;
  pieces_.forEdges([&](const Vec2&, const Vec2&) { ++count; });
  const std::size_t stride = paddedLanes(count);
  edges_.reserve(4 * stride);
  T* const rows = edges_.data();
  std::fill_n(rows, 4 * stride, T(0));
  T* to = rows;
  pieces_.forEdges([&](const Vec2& from, const Vec2& end) {
    to[0] = T(from.x);
    to[stride] = T(from.y);
    to[2 * stride] = T(end.x);
    to[3 * stride] = T(end.y);
    ++to;
  });
  EyePoint<T> eye;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    eye.position[axis] = eye_[axis][point];
    eye.normal[axis] = T(normal_[glm::length_t(axis)]);
  }
  return clip_.parts(targets_.lanes(), lane, eye,
                     {stride, {rows, rows + stride}, {rows + 2 * stride, rows + 3 * stride}});
}

/// One target's shadows from one point, in double precision.
template <class T>
void BatchVisibility<T>::uniteExactly(std::span<const Shadow> shadows) {
  const std::size_t at = shadows[0].at;
  const std::size_t point = at / targets_.lanes().count;
  const std::size_t lane = at % targets_.lanes().count;
  const GroupTarget& target = *group_[lane];
  united_.clear();
  for (const Shadow& shadow : shadows) united_.push_back(*blocked_targets_[shadow.use].what);
  const PointView view = exact_.look(points_[point].position, normal_,
                                     std::span(target.corners).first(target.corner_count), united_);
  const double fraction = view.whole > 0 ? view.visible / view.whole : 0;
  visible_.data()[at] = T(fraction * double(whole_.data()[at]));
  shape_.data()[at] = ShapeWord<T>(view.shape);
}

template class BatchVisibility<float>;
template class BatchVisibility<double>;

}  // namespace radiosity
