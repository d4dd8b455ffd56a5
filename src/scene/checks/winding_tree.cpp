#include "scene/checks/winding_tree.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>

#include "base/geometry/box.h"
#include "base/geometry/solid_angle.h"

namespace radiosity {

namespace {

/// From this many radii on a node represents its triangles. The next term of the expansion is then
/// at most about 1/16 of the node's own, and terms of opposite sides of a part cancel. The error is
/// far below the quarter that would change an answer.
constexpr double kFarRadii = 4;

/// Above the levels of any tree, since children have half of the triangles each. A walk keeps one
/// node a level waiting, and one more.
constexpr std::size_t kMostLevels = 66;

}  // namespace

WindingTree::WindingTree(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  if (!triangles_.empty()) build(0, triangles_.size());
}

std::size_t WindingTree::build(std::size_t begin, std::size_t end) {
  constexpr std::size_t kLeaf = 8;
  const std::size_t number = nodes_.size();
  Node node;
  node.begin = begin;
  node.end = end;
  measure(node);
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return number;
  Box3 box;
  for (std::size_t k = begin; k < end; ++k) box.add(triangles_[k].corners[0]);
  const int axis = box.longestAxis();
  const std::size_t middle = begin + (end - begin) / 2;
  const auto place = triangles_.begin();
  std::nth_element(place + std::ptrdiff_t(begin), place + std::ptrdiff_t(middle),
                   place + std::ptrdiff_t(end), [axis](const Triangle& a, const Triangle& b) {
                     return a.corners[0][axis] < b.corners[0][axis];
                   });
  build(begin, middle);
  const std::size_t second = build(middle, end);
  nodes_[number].second = second;
  return number;
}

void WindingTree::measure(Node& node) const {
  Vec3 weighted{0.0};
  double total = 0;
  for (std::size_t k = node.begin; k < node.end; ++k) {
    const auto& [a, b, c] = triangles_[k].corners;
    const Vec3 area = 0.5 * glm::cross(b - a, c - a);
    const double size = glm::length(area);
    node.area += area;
    weighted += size / 3 * (a + b + c);
    total += size;
  }
  node.middle = total > 0 ? weighted / total : triangles_[node.begin].corners[0];
  for (std::size_t k = node.begin; k < node.end; ++k) {
    for (const Vec3& corner : triangles_[k].corners) {
      node.radius = std::max(node.radius, glm::distance(corner, node.middle));
    }
  }
}

double WindingTree::around(const Vec3& point, Index own) const {
  double angle = 0;  // of nodes that count together
  SolidAngleSum near;
  std::array<std::size_t, kMostLevels> waiting;
  std::size_t count = 0;
  if (!nodes_.empty()) waiting[count++] = 0;
  while (count > 0) {
    const std::size_t number = waiting[--count];
    const Node& node = nodes_[number];
    const Vec3 towards = node.middle - point;
    const double distance = glm::length(towards);
    if (distance > kFarRadii * node.radius) {
      angle += glm::dot(towards, node.area) / (distance * distance * distance);
    } else if (node.second == 0) {
      for (std::size_t k = node.begin; k < node.end; ++k) {
        const Triangle& t = triangles_[k];
        if (own == kNone || t.plane != own) {
          near.add(
              halfSolidAngle(t.corners[0] - point, t.corners[1] - point, t.corners[2] - point));
        }
      }
    } else {
      waiting[count++] = number + 1;
      waiting[count++] = node.second;
    }
  }
  return (angle + near.value()) / (4 * std::numbers::pi);
}

}  // namespace radiosity
