#include "formfactor/exact/occluded/target_rows.h"

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
void TargetRows<T>::layOut(std::size_t targets, std::size_t corners) {
  const std::size_t stride = paddedLanes(targets);
  lanes_.corners = corners;
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
}

template <class T>
void TargetRows<T>::fill(std::span<const GroupTarget* const> targets, const Vec3& origin) {
  std::size_t corners = 4;
  for (const GroupTarget* target : targets) corners = std::max(corners, target->corner_count);
  layOut(targets.size(), corners);
  const std::size_t stride = lanes_.count;
  T* const rows = memory_.data();
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

template <class T>
void TargetRows<T>::fillFromEyes(const TargetLanes<T>& targets, std::size_t count,
                                 std::span<const std::array<T, 3>> eyes) {
  layOut(eyes.size() * count, targets.corners);
  const std::size_t rows = kCornerRow + 2 * targets.corners;
  // Rows of both stand as memory_ has them: a stride apart.
  const T* const from = targets.middle[0];
  for (std::size_t row = 0; row < rows; ++row) {
    T* const to = memory_.data() + row * lanes_.count;
    std::size_t lane = 0;
    for (const std::array<T, 3>& eye : eyes) {
      const T origin = row < 3 ? eye[row] : T(0);
      for (std::size_t t = 0; t < count; ++t) to[lane++] = from[row * targets.count + t] - origin;
    }
    std::fill(to + lane, to + lanes_.count, to[lane - 1]);
  }
}

template class TargetRows<float>;
template class TargetRows<double>;

}  // namespace radiosity
