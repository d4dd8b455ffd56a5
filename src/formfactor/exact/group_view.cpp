#include "formfactor/exact/group_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {
namespace {

constexpr std::size_t kPoints = SampleCell::kPoints;
/// Shadow counts of points that need no shadows: all is hidden.
constexpr std::uint8_t kHidden = 255;
constexpr std::uint8_t kMostCounted = 254;
constexpr std::uint64_t kAllHidden = 1;  ///< shape

std::uint32_t scrambled(std::uint32_t x) {
  x = (x + 1) * 0x85ebca6bU;
  x = (x ^ (x >> 15)) * 0xc2b2ae35U;
  return x ^ (x >> 13);
}

}  // namespace

template <class T>
void GroupView<T>::Lanes::resize(std::size_t count, std::size_t corners) {
  targets.count = (count + kLaneAlignment - 1) / kLaneAlignment * kLaneAlignment;
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
  for (std::size_t lane = 0; lane < all_.targets.count; ++lane) {
    const GroupTarget& target = *group_[std::min(lane, group_.size() - 1)];
    for (int axis = 0; axis < 3; ++axis) {
      all_.row(std::size_t(axis))[lane] = T(target.middle[axis] - origin[axis]);
      for (std::size_t k = 0; k < corners; ++k) {
        const Vec3& corner = target.corners[std::min(k, target.corner_count - 1)];
        all_.row(3 + 3 * k + std::size_t(axis))[lane] = T(corner[axis] - target.middle[axis]);
      }
    }
  }
}

template <class T>
void GroupView<T>::look(const SampleCell& cell, const Vec3& normal,
                        std::span<const GroupTarget* const> targets, std::span<CellValues> values) {
  group_ = targets;
  origin_ = 0.25 * (cell.corners[0] + cell.corners[1] + cell.corners[2] + cell.corners[3]);
  fill(origin_);
  form_factor_.reserve(all_.targets.count);
  shape_.reserve(all_.targets.count);
  for (std::size_t q = 0; q < kPoints; ++q) {
    points_[q] = cell.point(q);
    for (int axis = 0; axis < 3; ++axis) {
      eyes_[q].position[axis] = T(points_[q].position[axis] - origin_[axis]);
      eyes_[q].normal[axis] = T(normal[axis]);
    }
    kernels_.whole(all_.targets, eyes_[q], form_factor_.data());
    for (std::size_t lane = 0; lane < targets.size(); ++lane) {
      const double whole = double(form_factor_.data()[lane]);
      values[lane].whole[q] = whole;
      values[lane].visible[q] = whole;
      values[lane].shape[q] = 0;
    }
  }
  shadow_count_.assign(targets.size() * kPoints, 0);
  shadows_.clear();
  uses_.clear();
  for (std::size_t lane = 0; lane < targets.size(); ++lane) {
    values[lane].sampled = false;
    for (const Blocker& blocker : targets[lane]->blockers) {
      uses_.push_back({2 * blocker.id + Index(blocker.cuts_target), std::uint32_t(lane), &blocker});
    }
  }
  std::sort(uses_.begin(), uses_.end(), [](const Use& a, const Use& b) {
    return a.blocker != b.blocker ? a.blocker < b.blocker : a.lane < b.lane;
  });
  for (std::size_t begin = 0; begin < uses_.size();) {
    std::size_t end = begin + 1;
    while (end < uses_.size() && uses_[end].blocker == uses_[begin].blocker) ++end;
    drawShadows(std::span(uses_).subspan(begin, end - begin), values);
    begin = end;
  }
  unite(normal, values);
}

/// What one occluder hides of the targets it concerns.
template <class T>
void GroupView<T>::drawShadows(std::span<const Use> uses, std::span<CellValues> values) {
  Lanes* lanes = &all_;
  if (uses.size() < group_.size()) {
    lanes = &some_;
    some_.resize(uses.size(), all_.targets.corners);
    for (std::size_t k = 0; k < some_.targets.count; ++k) {
      some_.copyLane(k, all_, uses[std::min(k, uses.size() - 1)].lane);
    }
  }
  const Blocker& blocker = *uses[0].what;
  for (std::size_t q = 0; q < kPoints; ++q) {
    const Vec3& eye = points_[q].position;
    if (!blockingCone(*blocker.body, eye, blocker.cuts_target, cone_)) continue;
    if (cone_.inside) {
      for (const Use& use : uses) hide(use.lane, q, values);
      continue;
    }
    if (cone_.planes.size() > kMostPlanes) {
      for (const Use& use : uses) {
        addShadow(use, q);
        addShadow(use, q);  // twice: left to the exact clipper
      }
      continue;
    }
    planes_.clear();
    for (std::size_t k = 0; k < cone_.planes.size(); ++k) {
      const ClipPlane& plane = cone_.planes[k];
      const double scale = 1 / glm::length(plane.normal);
      const Vec3 n = plane.normal * scale;
      planes_.push_back({{T(n.x), T(n.y), T(n.z)},
                         T(plane.offset * scale),
                         scrambled(blocker.id * 64 + cone_.labels[k])});
    }
    kernels_.hidden(lanes->targets, eyes_[q], planes_.data(), planes_.size(), form_factor_.data(),
                    shape_.data());
    for (std::size_t k = 0; k < uses.size(); ++k) {
      const T hidden = form_factor_.data()[k];
      if (hidden == 0) continue;
      if (hidden == T(kHiddenWhole)) {
        hide(uses[k].lane, q, values);
        continue;
      }
      CellValues& value = values[uses[k].lane];
      // Both are rounded sums: kept from passing zero by their last digits.
      value.visible[q] = std::max(0.0, value.visible[q] - double(hidden));
      value.shape[q] += shape_.data()[k];
      addShadow(uses[k], q);
    }
  }
}

template <class T>
void GroupView<T>::hide(std::uint32_t lane, std::size_t point, std::span<CellValues> values) {
  shadow_count_[lane * kPoints + point] = kHidden;
  values[lane].visible[point] = 0;
  values[lane].shape[point] = kAllHidden;
}

template <class T>
void GroupView<T>::addShadow(const Use& use, std::size_t point) {
  const auto key = std::uint32_t(use.lane * kPoints + point);
  std::uint8_t& count = shadow_count_[key];
  if (count < kMostCounted) ++count;
  shadows_.push_back({key, use.what});
}

/// Points that see several shadows on one target: what the shadows have in common was subtracted
/// more than once.
template <class T>
void GroupView<T>::unite(const Vec3& normal, std::span<CellValues> values) {
  const auto alone = [&](const Shadow& s) {
    return shadow_count_[s.key] == 1 || shadow_count_[s.key] == kHidden;
  };
  std::erase_if(shadows_, alone);
  std::sort(shadows_.begin(), shadows_.end(), [](const Shadow& a, const Shadow& b) {
    return a.key != b.key ? a.key < b.key : a.what->id < b.what->id;
  });
  for (std::size_t begin = 0; begin < shadows_.size();) {
    const std::uint32_t key = shadows_[begin].key;
    united_.clear();
    std::size_t end = begin;
    for (; end < shadows_.size() && shadows_[end].key == key; ++end) {
      const bool again = end > begin && shadows_[end].what == shadows_[end - 1].what;
      if (!again) united_.push_back(*shadows_[end].what);
    }
    const std::size_t q = key % kPoints;
    CellValues& value = values[key / kPoints];
    const GroupTarget& target = *group_[key / kPoints];
    // Shifts of a rank-one lattice (Roberts 2018): where pictures are drawn, those of a cell's
    // points fill each other's gaps.
    const Vec2 shift(std::fmod(0.5 + 0.75487766624669276 * double(q), 1.0),
                     std::fmod(0.5 + 0.56984029099805327 * double(q), 1.0));
    const PointView view =
        exact_.look(points_[q].position, normal,
                    std::span(target.corners).first(target.corner_count), united_, shift);
    value.visible[q] = view.whole > 0 ? value.whole[q] * (view.visible / view.whole) : 0;
    value.shape[q] = view.shape;
    value.sampled |= view.sampled;
    begin = end;
  }
}

template class GroupView<float>;
template class GroupView<double>;

}  // namespace radiosity
