#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <unordered_map>
#include <unordered_set>

#include "base/geometry/plane_frame.h"
#include "mesh/cells/region/region.h"
#include "mesh/edge_key.h"

namespace radiosity {

namespace {

const double kRightAngle = glm::radians(90.0);
const double kLargestDeviation = glm::radians(45.0);

/// The largest deviation of a quadrilateral's corners from right angles, radians.
double deviation(const std::array<Vec2, 4>& p) {
  double largest = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2& before = p[(k + 3) % 4];
    const Vec2& after = p[(k + 1) % 4];
    if (cross2(p[k] - before, after - p[k]) <= 0) return 2 * kRightAngle;
    largest = std::max(largest, std::abs(angleAt(before, p[k], after) - kRightAngle));
  }
  return largest;
}

struct Pair {
  double score;
  std::size_t first;
  std::size_t second;
  Cell cell;
};

}  // namespace

std::vector<Cell> pairTriangles(const Region& region, const std::vector<Vec2>& interior,
                                const std::vector<std::array<Index, 3>>& triangles) {
  const std::size_t fixed = region.points.size();
  const auto position = [&](Index i) { return i < fixed ? region.points[i] : interior[i - fixed]; };
  std::unordered_set<std::uint64_t> pieces;
  for (const auto& loop : region.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      pieces.insert(edgeKey(loop[k], loop[(k + 1) % loop.size()]));
    }
  }
  for (const auto& [from, to] : region.inner) pieces.insert(edgeKey(from, to));

  std::vector<Pair> pairs;
  std::unordered_map<std::uint64_t, std::pair<std::size_t, Index>> open;  // triangle, apex
  open.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& triangle = triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index apex = triangle[k];
      const Index from = triangle[(k + 1) % 3];
      const Index to = triangle[(k + 2) % 3];
      const std::uint64_t key = edgeKey(from, to);
      const auto other = open.find(key);
      if (other == open.end()) {
        if (pieces.count(key) == 0) open.emplace(key, std::pair(t, apex));
        continue;
      }
      const Cell cell = {apex, from, other->second.second, to};
      const double score =
          deviation({position(cell[0]), position(cell[1]), position(cell[2]), position(cell[3])});
      if (score <= kLargestDeviation) pairs.push_back({score, other->second.first, t, cell});
      open.erase(other);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.score < b.score; });
  std::vector<bool> used(triangles.size(), false);
  std::vector<Cell> cells;
  for (const Pair& pair : pairs) {
    if (used[pair.first] || used[pair.second]) continue;
    used[pair.first] = used[pair.second] = true;
    cells.push_back(pair.cell);
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto& triangle = triangles[t];
    if (!used[t]) cells.push_back({triangle[0], triangle[1], triangle[2], kNone});
  }
  return cells;
}

}  // namespace radiosity
