#include "formfactor/exact/occluded/batch_cones.h"

#include <algorithm>
#include <array>
#include <bit>

namespace radiosity {

std::uint32_t scrambled(std::uint32_t x) {
  x = (x + 1) * 0x85ebca6bU;
  x = (x ^ (x >> 15)) * 0xc2b2ae35U;
  return x ^ (x >> 13);
}

template <class T>
void BatchCones<T>::setPoints(std::span<const SamplePoint> points) {
  static_assert(SamplePoints::kMost <= kLaneAlignment);
  points_.count = points.size();
  for (std::size_t q = 0; q < kLaneAlignment; ++q) {
    const Vec3& p = points[std::min(q, points.size() - 1)].position;
    for (int axis = 0; axis < 3; ++axis) points_.position[axis][q] = p[axis];
  }
}

template <class T>
ConeScratch BatchCones<T>::scratchFor(const Occluder& body) {
  if (above_.size() < body.planes.size()) above_.resize(body.planes.size());
  heights_.reserve(body.planes.size() * kLaneAlignment);
  return {heights_.data(), above_.data()};
}

template <class T>
bool BatchCones<T>::misses(const Blocker& blocker, std::span<const Vec3> outline) {
  if (telling_edge_.size() <= blocker.id) telling_edge_.resize(blocker.id + 1, 0);
  const std::uint32_t missed =
      kernels_.missed(*blocker.body, points_, outline.data(), outline.size(),
                      scratchFor(*blocker.body), telling_edge_[blocker.id]);
  return missed == (1U << points_.count) - 1;
}

template <class T>
void BatchCones<T>::build(std::span<const Blocker* const> blockers) {
  cones_.clear();
  for (std::size_t k = 0; k < 3; ++k) plane_[k].assign(2, T(0));
  plane_[3] = {T(1), T(-1)};
  label_.assign(2, 0);
  for (const Blocker* blocker : blockers) add(*blocker);
  // Kernels may read labels past the last cone's planes, up to the most that a cone may have.
  label_.resize(label_.size() + kMostPlanes);
}

template <class T>
void BatchCones<T>::resize(std::size_t planes) {
  for (std::vector<T>& row : plane_) row.resize(planes);
  label_.resize(planes);
}

template <class T>
void BatchCones<T>::add(const Blocker& blocker) {
  const Occluder& body = *blocker.body;
  const std::size_t most = body.edges.size() + body.planes.size();
  if (sides_.size() < most) sides_.resize(most);
  const std::size_t side_count =
      kernels_.cones(body, points_, blocker.cuts_target, scratchFor(body), sides_.data());
  const auto sides = std::span<const ConeSide<T>>(sides_).first(side_count);

  std::array<std::size_t, kLaneAlignment> count = {};
  for (const ConeSide<T>& side : sides) {
    for (std::size_t q = 0; q < points_.count; ++q) count[q] += side.points >> q & 1;
  }
  std::array<std::size_t, kLaneAlignment> at;
  std::size_t end = label_.size();
  std::uint32_t written = 0;
  for (std::size_t q = 0; q < points_.count; ++q) {
    if (count[q] == 0 || count[q] > kMostPlanes) {
      // No plane bounds the view from a point within the body, nor from one in a flat body's plane.
      const bool all = count[q] == 0 && !body.flat;
      const auto which = all ? ConePlanes<T>::kAllInside : ConePlanes<T>::kNothingInside;
      cones_.push_back({which, 1, count[q] > 0});
      continue;
    }
    cones_.push_back({LaneIndex<T>(end), LaneIndex<T>(count[q]), false});
    at[q] = end;
    end += count[q];
    written |= 1U << q;
  }
  resize(end);
  for (const ConeSide<T>& side : sides) {
    const std::uint32_t label = scrambled(blocker.id * 1024 + side.label);
    for (std::uint32_t left = side.points & written; left != 0; left &= left - 1) {
      const auto q = std::size_t(std::countr_zero(left));
      const std::size_t to = at[q]++;
      for (std::size_t axis = 0; axis < 3; ++axis) plane_[axis][to] = side.normal[axis][q];
      plane_[3][to] = side.offset[q];
      label_[to] = label;
    }
  }
}

template <class T>
ConePlanes<T> BatchCones<T>::planes() const {
  return {{plane_[0].data(), plane_[1].data(), plane_[2].data()}, plane_[3].data(), label_.data()};
}

template class BatchCones<float>;
template class BatchCones<double>;

}  // namespace radiosity
