#include "formfactor/hemicube/polygon_tree.h"

namespace radiosity {
namespace {

BoxTree boxesOf(const ViewScene& scene) {
  std::vector<Box3> boxes(scene.polygons.size());
  for (std::size_t p = 0; p < boxes.size(); ++p) {
    const ViewPolygon& polygon = scene.polygons[p];
    for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
      for (const Index v : scene.loop(l)) boxes[p].add(scene.vertices[v]);
    }
  }
  return BoxTree(boxes);
}

}  // namespace

PolygonTree::PolygonTree(const ViewScene& scene) : boxes(boxesOf(scene)), loop_offset{0} {
  polygons.reserve(scene.polygons.size());
  loop_offset.reserve(scene.loop_offset.size());
  corners.reserve(scene.corners.size());
  for (const Index p : boxes.order()) {
    ViewPolygon polygon = scene.polygons[p];
    const auto first = std::uint32_t(loop_offset.size() - 1);
    for (std::uint32_t l = polygon.loop_begin; l < polygon.loop_end; ++l) {
      for (const Index v : scene.loop(l)) corners.push_back(scene.vertices[v]);
      loop_offset.push_back(std::uint32_t(corners.size()));
    }
    polygon.loop_begin = first;
    polygon.loop_end = std::uint32_t(loop_offset.size() - 1);
    polygons.push_back(polygon);
  }
}

}  // namespace radiosity
