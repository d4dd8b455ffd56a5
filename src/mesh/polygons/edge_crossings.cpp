#include "mesh/polygons/edge_crossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Segment_2.h>

#include <algorithm>

#include "mesh/box_pairs.h"

namespace radiosity {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;

constexpr std::size_t kFewEdges = 8;  // up to this number we test all pairs

/// Two edges that leave `shared` overlap if they leave it in the same direction.
bool overlap(const Point& shared, const Point& p, const Point& q) {
  return CGAL::collinear(shared, p, q) && !CGAL::collinear_are_ordered_along_line(p, shared, q);
}

}  // namespace

bool anyCross(const WeldedPoints& points, const PlaneImage& image,
              const std::vector<std::array<Index, 2>>& edges) {
  const auto at = [&](Index v) {
    const Vec2 p = image(points[v]);
    return Point(p.x, p.y);
  };
  const auto cross = [&](const std::array<Index, 2>& e, const std::array<Index, 2>& f) {
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        if (e[i] == f[j]) return overlap(at(e[i]), at(e[1 - i]), at(f[1 - j]));
      }
    }
    return CGAL::do_intersect(Kernel::Segment_2(at(e[0]), at(e[1])),
                              Kernel::Segment_2(at(f[0]), at(f[1])));
  };
  if (edges.size() <= kFewEdges) {
    for (std::size_t k = 1; k < edges.size(); ++k) {
      for (std::size_t i = 0; i < k; ++i) {
        if (cross(edges[i], edges[k])) return true;
      }
    }
    return false;
  }
  std::vector<Box3> boxes(edges.size());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    for (const Index v : edges[k]) boxes[k].add(Vec3(image(points[v]), 0.0));
  }
  const auto pairs = overlappingPairs(boxes);
  return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
    return cross(edges[pair.first], edges[pair.second]);
  });
}

}  // namespace radiosity
