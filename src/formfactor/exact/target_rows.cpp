#include "formfactor/exact/target_rows.h"

#include <algorithm>

namespace radiosity {
namespace {

constexpr std::size_t kCornerRow = 9;

}  // namespace

void GroupTarget::setOutline(std::span<const Vec3> outline, const PlaneFrame& plane) {
  std::copy(outline.begin(), outline.end(), corners.begin());
  corner_count = outline.size();
  frame = plane;
  for (std::size_t k = 0; k < corner_count; ++k) flat[k] = frame.flat(corners[k]);
}

template <class T>
void TargetRows<T>::fill(std::span<const GroupTarget* const> targets, const Vec3& origin) {
  lanes_.corners = 4;
  for (const GroupTarget* target : targets) {
    lanes_.corners = std::max(lanes_.corners, target->corner_count);
  }
  const std::size_t stride = paddedLanes(targets.size());
  lanes_.count = stride;
  memory_.reserve(stride * (kCornerRow + 2 * kMostCorners));
  T* const rows = memory_.data();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lanes_.middle[axis] = rows + axis * stride;
    lanes_.axis[0][axis] = rows + (3 + axis) * stride;
    lanes_.axis[1][axis] = rows + (6 + axis) * stride;
  }
  for (std::size_t k = 0; k < kMostCorners; ++k) {
    lanes_.corner[k][0] = rows + (kCornerRow + 2 * k) * stride;
    lanes_.corner[k][1] = rows + (kCornerRow + 2 * k + 1) * stride;
  }
  for (std::size_t lane = 0; lane < stride; ++lane) {
    const GroupTarget& target = *targets[std::min(lane, targets.size() - 1)];
    T* to = rows + lane;
    const auto set = [&](double value) {
      *to = T(value);
      to += stride;
    };
    for (int axis = 0; axis < 3; ++axis) set(target.frame.origin[axis] - origin[axis]);
    for (int axis = 0; axis < 3; ++axis) set(target.frame.u[axis]);
    for (int axis = 0; axis < 3; ++axis) set(target.frame.v[axis]);
    for (std::size_t k = 0; k < lanes_.corners; ++k) {
      const Vec2& corner = target.flat[std::min(k, target.corner_count - 1)];
      set(corner.x);
      set(corner.y);
    }
  }
}

template class TargetRows<float>;
template class TargetRows<double>;

}  // namespace radiosity
