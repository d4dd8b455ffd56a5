#include "lightmap/charts.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "base/geometry/box_tree.h"

namespace radiosity {
namespace {

using Triangle2 = std::array<Vec2, 3>;

/// The narrowest cone, degrees. A chart that still overlaps itself is split into single triangles.
constexpr double kLeastCone = 1;
/// Share of a chart's box. Faces within this distance of a plane count as in it, and triangles may
/// overlap by as much.
constexpr double kFlat = 1e-6;

/// Tolerance of a cosine: faces in a plane with corners in floats bend by about 1e-6 radians.
constexpr double kRounding = 1e-9;

double cosineOf(double degrees) { return std::cos(degrees * std::numbers::pi / 180); }

/// Whether all of `b` lies on the outer side of an edge of `a`, within `slack`.
bool isApartAlong(const Triangle2& a, const Triangle2& b, double slack) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 edge = a[(k + 1) % 3] - a[k];
    const double length = glm::length(edge);
    bool outside = true;
    for (const Vec2& p : b) outside = outside && cross2(edge, p - a[k]) <= slack * length;
    if (outside) return true;
  }
  return false;
}

/// Both must be counter-clockwise. Two convex shapes do not overlap if an edge of one separates
/// them.
bool overlap(const Triangle2& a, const Triangle2& b, double slack) {
  return !isApartAlong(a, b, slack) && !isApartAlong(b, a, slack);
}

class ChartMaker {
 public:
  ChartMaker(std::span<const FaceTriangle> triangles, double crease, const Progress& progress)
      : triangles_(triangles),
        crease_(cosineOf(crease) - kRounding),
        progress_(progress),
        chart_of_(triangles.size(), kNone) {}

  std::vector<Chart> run() {
    std::vector<Index> all(triangles_.size());
    std::iota(all.begin(), all.end(), Index(0));
    cover(all, kChartCone);
    return std::move(charts_);
  }

 private:
  void cover(std::span<const Index> triangles, double cone);
  std::vector<Index> grow(Index seed, double cone, Index mark);
  Chart lay(std::vector<Index> triangles, Index seed) const;
  Vec3 longestBorder(const Chart& chart) const;
  bool liesOverItself(const Chart& chart) const;

  std::span<const FaceTriangle> triangles_;
  double crease_;
  const Progress& progress_;
  /// The mark of each triangle's region; kNone: it is in no region yet. A new region takes only
  /// triangles without one.
  std::vector<Index> chart_of_;
  Index marks_ = 0;
  std::vector<Chart> charts_;
};

/// Makes charts of the triangles that are in none. A chart that overlaps itself is made again in
/// narrower cones; at the end each triangle is a chart.
void ChartMaker::cover(std::span<const Index> triangles, double cone) {
  for (const Index seed : triangles) {
    if (chart_of_[seed] != kNone) continue;
    progress_.check();
    Chart chart = lay(grow(seed, cone, marks_++), seed);
    if (!liesOverItself(chart)) {
      charts_.push_back(std::move(chart));
      continue;
    }
    const std::vector<Index> again = std::move(chart.triangles);
    if (cone > kLeastCone) {
      for (const Index t : again) chart_of_[t] = kNone;
      cover(again, 0.5 * cone);
    } else {
      for (const Index t : again) charts_.push_back(lay({t}, t));
    }
  }
}

std::vector<Index> ChartMaker::grow(Index seed, double cone, Index mark) {
  const double least = cosineOf(cone);
  std::vector<Index> region = {seed};
  chart_of_[seed] = mark;
  for (std::size_t k = 0; k < region.size(); ++k) {
    const FaceTriangle& from = triangles_[region[k]];
    for (const Index next : from.neighbour) {
      if (next == kNone || chart_of_[next] != kNone) continue;
      const Vec3& normal = triangles_[next].normal;
      if (glm::dot(normal, from.normal) < crease_) continue;
      if (glm::dot(normal, triangles_[seed].normal) < least) continue;
      chart_of_[next] = mark;
      region.push_back(next);
    }
  }
  std::sort(region.begin(), region.end());
  return region;
}

/// The longest edge on the border of the chart; the first edge of all if it is closed.
Vec3 ChartMaker::longestBorder(const Chart& chart) const {
  const auto has = [&](Index t) {
    return std::binary_search(chart.triangles.begin(), chart.triangles.end(), t);
  };
  const FaceTriangle& first = triangles_[chart.triangles.front()];
  Vec3 longest = first.position[1] - first.position[0];
  double most = 0;
  for (const Index t : chart.triangles) {
    const FaceTriangle& triangle = triangles_[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const Index next = triangle.neighbour[k];
      if (next != kNone && has(next)) continue;
      const Vec3 edge = triangle.position[(k + 1) % 3] - triangle.position[k];
      const Vec3 flat = edge - glm::dot(edge, chart.frame.n) * chart.frame.n;
      if (glm::length(flat) <= most) continue;
      most = glm::length(flat);
      longest = flat;
    }
  }
  return longest;
}

Chart ChartMaker::lay(std::vector<Index> triangles, Index seed) const {
  Chart chart;
  chart.triangles = std::move(triangles);
  chart.frame.n = triangles_[seed].normal;
  const Vec3 origin = triangles_[seed].position[0];
  chart.frame = makeFrame(origin, chart.frame.n, longestBorder(chart));
  const auto boxOfChart = [&] {
    Box2 box;
    for (const Index t : chart.triangles) {
      for (const Vec3& p : triangles_[t].position) box.add(chart.frame.flat(p));
    }
    return box;
  };
  Box2 box = boxOfChart();
  if (box.size().y > box.size().x) {
    chart.frame = makeFrame(origin, chart.frame.n, chart.frame.v);
    box = boxOfChart();
  }
  chart.low = box.low;
  chart.size = box.size();
  for (const Index t : chart.triangles) {
    chart.least_cosine =
        std::min(chart.least_cosine, glm::dot(triangles_[t].normal, chart.frame.n));
  }
  return chart;
}

/// Whether two triangles of the chart overlap. False for a planar chart: overlapping faces are
/// there at the same place, with the same light. True if too many boxes meet to test all pairs.
bool ChartMaker::liesOverItself(const Chart& chart) const {
  const double slack = kFlat * glm::length(chart.size);
  double height = 0;
  std::vector<Triangle2> flat;
  std::vector<Box3> boxes;
  for (const Index t : chart.triangles) {
    Triangle2 triangle;
    Box3 box;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = triangles_[t].position[k];
      height = std::max(height, std::abs(glm::dot(p - chart.frame.origin, chart.frame.n)));
      triangle[k] = chart.frame.flat(p);
      box.add(Vec3(triangle[k], 0.0));
    }
    flat.push_back(triangle);
    boxes.push_back(box);
  }
  if (height <= slack) return false;
  constexpr std::size_t kPairs = 64;  // a triangle usually meets its neighbours and theirs
  std::size_t left = kPairs * flat.size();
  const BoxTree tree(boxes);
  for (std::size_t a = 0; a < flat.size(); ++a) {
    bool over = false;
    tree.query(boxes[a], [&](Index b) {
      if (b <= a) return true;
      over = left == 0 || overlap(flat[a], flat[b], slack);
      left -= left > 0 ? 1 : 0;
      return !over;
    });
    if (over) return true;
  }
  return false;
}

}  // namespace

std::vector<Chart> makeCharts(std::span<const FaceTriangle> triangles, double crease,
                              const Progress& progress) {
  return ChartMaker(triangles, crease, progress).run();
}

}  // namespace radiosity
