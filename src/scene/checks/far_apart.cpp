#include "scene/checks/far_apart.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "base/geometry/box.h"

namespace radiosity {
namespace {

/// The least gap, relative to the larger of the groups that it separates.
constexpr double kFarApart = 1000;

struct FaceBox {
  Box3 box;
  Index face;
};

std::vector<FaceBox> boxesOf(const Scene& scene) {
  std::vector<FaceBox> boxes;
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    if (scene.face(f).empty()) continue;
    FaceBox of{{}, Index(f)};
    for (const Index v : scene.face(f)) of.box.add(scene.vertices[v]);
    boxes.push_back(of);
  }
  return boxes;
}

struct Parted {
  std::size_t first;  ///< box after the gap
  double gap;
};

/// Finds the gap along an axis that separates boxes, sorted by their lower ends, into two groups.
std::optional<Parted> partAlong(const std::vector<FaceBox>& boxes, glm::length_t axis) {
  std::vector<Box3> rest(boxes.size());  // rest[k]: the union of boxes from k on
  for (std::size_t k = boxes.size(); k-- > 0;) {
    if (k + 1 < boxes.size()) rest[k] = rest[k + 1];
    rest[k].add(boxes[k].box);
  }
  Box3 before = boxes[0].box;
  for (std::size_t k = 1; k < boxes.size(); ++k) {
    const double gap = boxes[k].box.low[axis] - before.high[axis];
    if (gap > kFarApart * std::max(before.diagonal(), rest[k].diagonal())) return Parted{k, gap};
    before.add(boxes[k].box);
  }
  return std::nullopt;
}

}  // namespace

std::optional<Note> noteFarApart(const Scene& scene, double weld) {
  std::vector<FaceBox> boxes = boxesOf(scene);
  if (boxes.empty()) return std::nullopt;
  Box3 whole;
  for (const FaceBox& of : boxes) whole.add(of.box);
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    std::sort(boxes.begin(), boxes.end(), [axis](const FaceBox& a, const FaceBox& b) {
      return a.box.low[axis] < b.box.low[axis];
    });
    const std::optional<Parted> parted = partAlong(boxes, axis);
    if (!parted) continue;
    const bool first_are_fewer = 2 * parted->first <= boxes.size();
    const std::size_t count = first_are_fewer ? parted->first : boxes.size() - parted->first;
    const Index face = boxes[first_are_fewer ? 0 : parted->first].face;
    return Note{Severity::warning,
                fmt::format("{} of {} faces ({}) lie {:.3g} m from all others: lengths below "
                            "{:.3g} m, a share of the scene's diagonal, count as nothing in things "
                            "larger than {:.3g} m; move these faces closer or leave them out",
                            count, boxes.size(), scene.surfaces[scene.face_surface[face]].name,
                            parted->gap, weld * whole.diagonal(), 1e4 * weld * whole.diagonal())};
  }
  return std::nullopt;
}

}  // namespace radiosity
