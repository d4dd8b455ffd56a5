#include "mesh/winding_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>

#include "mesh/box_pairs.h"

namespace radiosity {

namespace {

constexpr Index kLeaf = 8;
// Groups farther away than so many of their radii are seen as dipoles, with errors of about the
// inverse square of it (Barill et al. take 2).
constexpr double kFar = 3.0;

Vec3 middleOf(const std::array<Vec3, 3>& t) { return (t[0] + t[1] + t[2]) / 3.0; }

}  // namespace

double solidAngle(const Vec3& from, const std::array<Vec3, 3>& triangle) {
  const Vec3 a = triangle[0] - from;
  const Vec3 b = triangle[1] - from;
  const Vec3 c = triangle[2] - from;
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  const double numerator = glm::dot(a, glm::cross(b, c));
  const double denominator =
      la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(numerator, denominator);
}

WindingTree::WindingTree(const std::vector<std::array<Vec3, 3>>& triangles,
                         const std::vector<Index>& plane)
    : triangles_(triangles), plane_(plane), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), Index(0));
  if (!order_.empty()) build(0, Index(order_.size()));
}

Index WindingTree::build(Index begin, Index end) {
  const Index number = Index(nodes_.size());
  nodes_.emplace_back();
  Node node;
  node.begin = begin;
  node.end = end;
  Box3 box;
  Box3 middles;
  double weight = 0;
  for (Index k = begin; k < end; ++k) {
    const auto& t = triangles_[order_[k]];
    const Vec3 area = 0.5 * glm::cross(t[1] - t[0], t[2] - t[0]);
    node.area += area;
    node.centre += glm::length(area) * middleOf(t);
    weight += glm::length(area);
    for (const Vec3& p : t) box.add(p);
    middles.add(middleOf(t));
  }
  node.centre = weight > 0 ? node.centre / weight : middles.low;
  for (Index k = begin; k < end; ++k) {
    for (const Vec3& p : triangles_[order_[k]]) {
      node.radius = std::max(node.radius, glm::distance(p, node.centre));
    }
  }
  if (end - begin > kLeaf) {
    const Vec3 extent = middles.high - middles.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const Index half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](Index a, Index b) {
                       const double x = middleOf(triangles_[a])[axis];
                       const double y = middleOf(triangles_[b])[axis];
                       return x != y ? x < y : a < b;
                     });
    node.left = build(begin, half);
    node.right = build(half, end);
  }
  nodes_[number] = node;
  return number;
}

double WindingTree::sum(Index number, const Vec3& from, Index own) const {
  const Node& node = nodes_[number];
  const Vec3 to = node.centre - from;
  const double distance = glm::length(to);
  if (distance > kFar * node.radius) {
    return glm::dot(node.area, to) / (distance * distance * distance);
  }
  if (node.left != kNone) return sum(node.left, from, own) + sum(node.right, from, own);
  double total = 0;
  for (Index k = node.begin; k < node.end; ++k) {
    const Index t = order_[k];
    if (plane_[t] != own) total += solidAngle(from, triangles_[t]);
  }
  return total;
}

double WindingTree::around(const Vec3& from, Index own) const {
  return nodes_.empty() ? 0.0 : sum(0, from, own) / (4.0 * std::numbers::pi);
}

}  // namespace radiosity
