// A scene's polygons by place, for drawing them front to back.
#pragma once

#include <vector>

#include "base/geometry/box_tree.h"
#include "formfactor/view_scene.h"

namespace radiosity {

/// A tree over the polygons' boxes, and the polygons once more, leaf by leaf: those that are drawn
/// together lie together in memory.
struct PolygonTree {
  explicit PolygonTree(const ViewScene& scene);

  BoxTree boxes;  ///< of ViewScene::polygons, by position
  /// Leaf by leaf, as boxes.order(); with loops in `loop_offset` and `corners`, below.
  std::vector<ViewPolygon> polygons;
  std::vector<std::uint32_t> loop_offset;  ///< L + 1, into corners
  std::vector<Vec3> corners;

  std::size_t bytes() const {
    return boxes.bytes() + polygons.size() * sizeof(ViewPolygon) +
           loop_offset.size() * sizeof(std::uint32_t) + corners.size() * sizeof(Vec3);
  }
};

}  // namespace radiosity
