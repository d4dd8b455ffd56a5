#include "mesh/welded_points.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace radiosity {

std::uint64_t WeldedPoints::key(const Cell& cell) {
  return std::uint64_t(cell.x) * 0x9e3779b97f4a7c15ull ^
         std::uint64_t(cell.y) * 0xc2b2ae3d27d4eb4full ^
         std::uint64_t(cell.z) * 0x165667b19e3779f9ull;
}

WeldedPoints::Cell WeldedPoints::cellOf(const Vec3& p, const Layer& layer) {
  return Cell(glm::floor(p / (2.0 * layer.radius)));
}

WeldedPoints::Layer& WeldedPoints::layerOf(double radius) {
  for (Layer& layer : layers_) {
    if (layer.radius == radius) return layer;
  }
  layers_.push_back({radius, {}});
  return layers_.back();
}

/// Calls take(point, distance) for each point closer than both radii. Two cells may share a key:
/// then it may be called twice for a point.
template <class Take>
void WeldedPoints::forNear(const Vec3& p, double radius, const Take& take) const {
  for (const Layer& layer : layers_) {
    const double reach = std::min(radius, layer.radius);
    // Cells are two radii wide, so a ball around p meets at most the eight cells around its nearest
    // cell corner.
    const Cell base(glm::floor(p / (2.0 * layer.radius) - 0.5));
    for (int corner = 0; corner < 8; ++corner) {
      const Cell cell = base + Cell(corner & 1, corner >> 1 & 1, corner >> 2);
      const auto [begin, end] = layer.cells.equal_range(key(cell));
      for (auto it = begin; it != end; ++it) {
        const double d = glm::distance(points_[it->second], p);
        if (d < reach) take(it->second, d);
      }
    }
  }
}

Index WeldedPoints::find(const Vec3& p, double radius) const {
  Index best = kNone;
  double best_distance = radius;
  forNear(p, radius, [&](Index point, double d) {
    // Of equally near points the older wins, so that the order within a bucket does not matter.
    if (d > best_distance || (d == best_distance && point > best)) return;
    best = point;
    best_distance = d;
  });
  return best;
}

std::vector<Index> WeldedPoints::findAll(const Vec3& p, double radius) const {
  std::vector<Index> out;
  forNear(p, radius, [&](Index point, double) { out.push_back(point); });
  std::ranges::sort(out);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Index WeldedPoints::insert(const Vec3& p, double radius) {
  const Index known = find(p, radius);
  if (known != kNone) return known;
  const Index added = Index(points_.size());
  points_.push_back(p);
  radius_.push_back(radius);
  Layer& layer = layerOf(radius);
  layer.cells.emplace(key(cellOf(p, layer)), added);
  return added;
}

void WeldedPoints::retire(Index i) {
  Layer& layer = layerOf(radius_[i]);
  const auto [begin, end] = layer.cells.equal_range(key(cellOf(points_[i], layer)));
  for (auto it = begin; it != end; ++it) {
    if (it->second != i) continue;
    layer.cells.erase(it);
    return;
  }
}

std::vector<Index> weldPoints(std::span<const Vec3> places, std::span<const double> radius,
                              WeldedPoints& points) {
  WeldedPoints found;
  std::vector<Index> of_place;  // into found
  std::vector<std::vector<Index>> members;
  for (Index k = 0; k < places.size(); ++k) {
    of_place.push_back(found.insert(places[k], radius[k]));
    members.resize(found.size());
    members[of_place.back()].push_back(k);
  }
  // Noise as large as the radius leaves several points where one was meant.
  for (Index k = 0; k < places.size(); ++k) {
    const std::vector<Index> group = found.findAll(places[k], radius[k]);
    const auto isNear = [&](Index other) {
      return glm::distance(places[k], places[other]) < std::min(radius[k], radius[other]);
    };
    const auto areNear = [&](Index point) { return std::ranges::all_of(members[point], isNear); };
    if (group.size() < 2 || !std::ranges::all_of(group, areNear)) continue;
    for (const Index point : group) found.retire(point);
    const Index one = found.insert(places[k], radius[k]);
    members.resize(found.size());
    for (const Index point : group) {
      for (const Index member : members[point]) of_place[member] = one;
      members[one].insert(members[one].end(), members[point].begin(), members[point].end());
      members[point].clear();
    }
  }
  // Numbered by place, as points were that are one from the start.
  points = {};
  std::vector<Index> number(found.size(), kNone);
  for (Index& point : of_place) {
    if (number[point] == kNone) number[point] = points.insert(found[point], found.radius(point));
    point = number[point];
  }
  return of_place;
}

}  // namespace radiosity
