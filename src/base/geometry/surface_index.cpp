#include "base/geometry/surface_index.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

namespace radiosity {
namespace {

constexpr std::size_t kLeafFaces = 4;

}  // namespace

Vec3 nearestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double d1 = glm::dot(ab, p - a);
  const double d2 = glm::dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = glm::dot(ab, p - b);
  const double d4 = glm::dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  const double d5 = glm::dot(ab, p - c);
  const double d6 = glm::dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

SurfaceIndex::SurfaceIndex(std::span<const Vec3> vertices,
                           std::span<const std::array<Index, 3>> triangles)
    : vertices_(vertices), triangles_(triangles), order_(triangles.size()) {
  std::iota(order_.begin(), order_.end(), std::uint32_t(0));
  normal_.reserve(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto [a, b, c] = cornersOf(t);
    const Vec3 cross = glm::cross(b - a, c - a);
    const double length = glm::length(cross);
    normal_.push_back(length > 0 ? cross / length : Vec3(0.0));
  }
  if (!order_.empty()) build(0, order_.size());
}

std::array<Vec3, 3> SurfaceIndex::cornersOf(std::size_t triangle) const {
  const std::array<Index, 3>& t = triangles_[triangle];
  return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
}

void SurfaceIndex::build(std::size_t begin, std::size_t end) {
  Node node;
  for (std::size_t k = begin; k < end; ++k) {
    for (const Vec3& corner : cornersOf(order_[k])) node.box.add(corner);
  }
  const std::size_t place = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kLeafFaces) {
    nodes_[place].begin = std::uint32_t(begin);
    nodes_[place].count = std::uint32_t(end - begin);
    return;
  }
  const int axis = node.box.longestAxis();
  const auto middle = [&](std::uint32_t t) {
    const auto [a, b, c] = cornersOf(t);
    return a[axis] + b[axis] + c[axis];
  };
  const std::size_t half = begin + (end - begin) / 2;
  const auto at = [&](std::size_t k) { return order_.begin() + std::ptrdiff_t(k); };
  std::nth_element(at(begin), at(half), at(end), [&](std::uint32_t s, std::uint32_t t) {
    const double ms = middle(s);
    const double mt = middle(t);
    return ms != mt ? ms < mt : s < t;
  });
  build(begin, half);
  nodes_[place].begin = std::uint32_t(nodes_.size());
  build(half, end);
}

double SurfaceIndex::distance2(const Node& node, const Vec3& point) const {
  const Vec3 outside = glm::max(glm::max(node.box.low - point, point - node.box.high), Vec3(0.0));
  return glm::dot(outside, outside);
}

std::optional<NearestPoint> SurfaceIndex::nearest(const Vec3& point, const Vec3& normal,
                                                  double reach, double least_cosine) const {
  std::optional<NearestPoint> best;
  double least = reach * reach;
  std::vector<std::size_t> waiting;
  if (!nodes_.empty()) waiting.push_back(0);
  while (!waiting.empty()) {
    const std::size_t place = waiting.back();
    waiting.pop_back();
    const Node& node = nodes_[place];
    if (distance2(node, point) > least) continue;
    if (node.count == 0) {
      waiting.push_back(node.begin);
      waiting.push_back(place + 1);
      continue;
    }
    for (std::size_t k = node.begin; k < node.begin + node.count; ++k) {
      const std::size_t t = order_[k];
      if (!(glm::dot(normal_[t], normal) >= least_cosine)) continue;
      const auto [a, b, c] = cornersOf(t);
      const Vec3 w = nearestOnTriangle(point, a, b, c);
      const Vec3 apart = a * w.x + b * w.y + c * w.z - point;
      const double d2 = glm::dot(apart, apart);
      if (d2 > least || (best && d2 == least && best->triangle < t)) continue;
      least = d2;
      best = NearestPoint{t, w, std::sqrt(d2)};
    }
  }
  return best;
}

}  // namespace radiosity
