#include "mesh/welded_points.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace radiosity {

std::uint64_t WeldedPoints::key(const Cell& cell) {
  return std::uint64_t(cell.x) * 0x9e3779b97f4a7c15ull ^
         std::uint64_t(cell.y) * 0xc2b2ae3d27d4eb4full ^
         std::uint64_t(cell.z) * 0x165667b19e3779f9ull;
}

Index WeldedPoints::find(const Vec3& p) const {
  // Cells are two radii wide, so a ball around p meets at most the eight cells around its nearest
  // cell corner.
  const Cell base(glm::floor(p / cell_ - 0.5));
  Index best = kNone;
  double best_distance = radius_;
  for (int corner = 0; corner < 8; ++corner) {
    const Cell cell = base + Cell(corner & 1, corner >> 1 & 1, corner >> 2);
    const auto [begin, end] = cells_.equal_range(key(cell));
    for (auto it = begin; it != end; ++it) {
      const double d = glm::distance(points_[it->second], p);
      // Of equally near points the older wins, so that the order within a bucket does not matter.
      if (d < best_distance || (d == best_distance && best != kNone && it->second < best)) {
        best = it->second;
        best_distance = d;
      }
    }
  }
  return best;
}

Index WeldedPoints::insert(const Vec3& p) {
  const Index known = find(p);
  if (known != kNone) return known;
  const Index added = Index(points_.size());
  points_.push_back(p);
  cells_.emplace(key(Cell(glm::floor(p / cell_))), added);
  return added;
}

void WeldedPoints::retire(Index i) {
  const auto [begin, end] = cells_.equal_range(key(Cell(glm::floor(points_[i] / cell_))));
  for (auto it = begin; it != end; ++it) {
    if (it->second != i) continue;
    cells_.erase(it);
    return;
  }
}

}  // namespace radiosity
