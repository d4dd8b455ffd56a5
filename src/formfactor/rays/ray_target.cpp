#include "formfactor/rays/ray_target.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "base/parallel.h"

namespace radiosity {

namespace {

/// The cell at a coordinate of a grid: cells are centred on whole numbers.
std::int32_t cellAt(float x, std::int32_t cells) {
  constexpr float kHalf = 0.5;
  return std::clamp(std::int32_t(x + kHalf), 0, cells - 1);
}

}  // namespace

/// Where a grid's cells begin, or the item that all of them are.
struct RayTargets::GridPlace {
  bool single;
  std::int32_t first;
};

RayTargets::GridPlace RayTargets::append(const PatchGrid& grid) {
  const std::size_t cells_before = cells_.size();
  const std::size_t nodes_before = nodes_.size();
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  std::int32_t most = 0;
  const auto place = [&](std::int32_t entry) {
    if (entry < 0) return ~(~entry + std::int32_t(nodes_before));
    least = std::min(least, entry);
    most = std::max(most, entry);
    return entry;
  };
  for (const std::int32_t entry : grid.cells()) cells_.push_back(place(entry));
  for (CellNode node : grid.nodes()) {
    node.inside = place(node.inside);
    node.outside = place(node.outside);
    nodes_.push_back(node);
  }
  if (least != most) return {false, std::int32_t(cells_before)};
  // The whole side counts for one item: there is nothing to look up.
  cells_.resize(cells_before);
  nodes_.resize(nodes_before);
  return {true, least};
}

RayTargets::RayTargets(const ViewScene& scene, const EmbreeScene& embree) {
  std::vector<GridPlace> place_of;
  place_of.reserve(scene.grids.size());
  for (const PatchGrid& grid : scene.grids) place_of.push_back(append(grid));
  const auto targetOf = [&](std::size_t triangle, const ViewPolygon& polygon,
                            const PolygonSide& side) {
    RayTarget target;
    target.polygon = polygon.source;
    if (side.grid == kNone || place_of[side.grid].single) {
      target.first = side.grid == kNone ? std::int32_t(side.item) : place_of[side.grid].first;
      return target;
    }
    const PatchGrid& grid = scene.grids[side.grid];
    const auto& corners = embree.triangles()[triangle];
    const Vec3 a = embree.vertices()[corners[0]];
    const Vec3 ab = embree.vertices()[corners[1]] - a;
    const Vec3 ac = embree.vertices()[corners[2]] - a;
    const Vec3 from = a - polygon.origin;
    const auto along = [&](const Vec3& axis, double offset) {
      return std::array{float(glm::dot(axis, from) + offset), float(glm::dot(axis, ab)),
                        float(glm::dot(axis, ac))};
    };
    target.u = along(grid.uAxis(), grid.uOffset());
    target.v = along(grid.vAxis(), grid.vOffset());
    target.columns = grid.columns();
    target.rows = grid.rows();
    target.first = place_of[side.grid].first;
    return target;
  };
  const std::size_t triangles = embree.triangles().size();
  targets_.resize(2 * std::max<std::size_t>(triangles, 1));
  parallelFor(triangles, 1024, [&](std::size_t t) {
    const ViewPolygon& polygon = scene.polygons[embree.polygonOf()[t]];
    for (std::size_t side = 0; side < 2; ++side) {
      targets_[2 * t + side] = targetOf(t, polygon, polygon.side[side]);
    }
  });
}

std::uint32_t RayTargets::itemAt(std::uint32_t triangle, int side, float s, float t) const {
  const RayTarget& target = targets_[2 * std::size_t(triangle) + std::size_t(side)];
  if (target.columns == 0) return std::uint32_t(target.first);
  const float u = target.u[0] + s * target.u[1] + t * target.u[2];
  const float v = target.v[0] + s * target.v[1] + t * target.v[2];
  const std::int32_t cell = cellAt(v, target.rows) * target.columns + cellAt(u, target.columns);
  const std::int32_t entry = cells_[std::size_t(target.first) + std::size_t(cell)];
  return entry >= 0 ? std::uint32_t(entry) : leafOf(entry, u, v);
}

std::uint32_t RayTargets::leafOf(std::int32_t entry, float u, float v) const {
  while (entry < 0) {
    const std::int32_t at = ~entry;
    const CellNode& node = nodes_[std::size_t(at)];
    entry = node.a * u + node.b * v + node.c >= 0 ? node.inside : node.outside;
  }
  return std::uint32_t(entry);
}

}  // namespace radiosity
