// The patch that a ray has hit, found from the place on a triangle where it ended.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>

#include "formfactor/rays/embree_scene.h"

namespace radiosity {

/// The item that one side of a triangle counts for, and the map from a hit's position (Embree's s
/// and t) to the grid of its polygon: u[0] + u[1] s + u[2] t.
struct RayTarget {
  const PatchGrid* grid = nullptr;  ///< null: `item` everywhere
  std::array<float, 3> u{};
  std::array<float, 3> v{};
  std::uint32_t item = 0;

  /// Looks items up in a grid of triangle `t`'s polygon.
  void place(const PatchGrid& of, const EmbreeScene& embree, std::size_t t, const Vec3& origin) {
    const auto& corners = embree.triangles()[t];
    const Vec3 a = embree.vertices()[corners[0]];
    const Vec3 ab = embree.vertices()[corners[1]] - a;
    const Vec3 ac = embree.vertices()[corners[2]] - a;
    const Vec3 from = a - origin;
    grid = &of;
    u = {float(glm::dot(of.uAxis(), from) + of.uOffset()), float(glm::dot(of.uAxis(), ab)),
         float(glm::dot(of.uAxis(), ac))};
    v = {float(glm::dot(of.vAxis(), from) + of.vOffset()), float(glm::dot(of.vAxis(), ab)),
         float(glm::dot(of.vAxis(), ac))};
  }

  /// As PolygonSide::item.
  std::uint32_t itemAt(float s, float t) const {
    if (grid == nullptr) return item;
    const float gu = u[0] + s * u[1] + t * u[2];
    const float gv = v[0] + s * v[1] + t * v[2];
    const std::int32_t column = cellAt(gu, grid->columns());
    const std::int32_t row = cellAt(gv, grid->rows());
    std::int32_t entry =
        grid->cells()[std::size_t(row) * std::size_t(grid->columns()) + std::size_t(column)];
    while (entry < 0) {
      const CellNode& node = grid->node(~entry);
      entry = node.a * gu + node.b * gv + node.c >= 0 ? node.inside : node.outside;
    }
    return std::uint32_t(entry);
  }

 private:
  /// The cell of a grid at a coordinate: cells are centred on whole numbers.
  static std::int32_t cellAt(float x, std::int32_t cells) {
    constexpr float kHalf = 0.5;
    return std::clamp(std::int32_t(x + kHalf), 0, cells - 1);
  }
};

}  // namespace radiosity
