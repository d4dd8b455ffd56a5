#include "lightmap/chart_texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/surface_index.h"
#include "radiosity/lightmap.h"

namespace radiosity {
namespace {

constexpr double kReach = kLightmapPadding;

/// The part of a triangle between two heights: its least and greatest x.
struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

Span spanBetween(const std::array<Vec3, 3>& p, double top, double bottom) {
  Span span;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& a = p[k];
    const Vec3& b = p[(k + 1) % 3];
    if (a.y >= top && a.y <= bottom) span.add(a.x);
    for (const double y : {top, bottom}) {
      if ((a.y < y) == (b.y < y)) continue;
      span.add(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
    }
  }
  return span;
}

struct Nearest {
  double square = kReach * kReach;  ///< square of the distance, texels
  Index triangle = kNone;
};

/// The texels of a chart's place, row by row; each keeps the nearest triangle.
class TexelGrid {
 public:
  explicit TexelGrid(const ChartPlace& place)
      : place_(place), cells_(std::size_t(place.width) * std::size_t(place.height)) {}

  Vec3 centre(int x, int y) const { return {x + 0.5, y + 0.5, 0.0}; }
  const Nearest& at(int x, int y) const { return cells_[index(x, y)]; }

  /// `p`: corners, in texels of the map.
  void draw(Index triangle, const std::array<Vec3, 3>& p) {
    const auto [low, high] = std::minmax({p[0].y, p[1].y, p[2].y});
    const int first = std::max(place_.y, int(std::floor(low - kReach - 0.5)));
    const int last = std::min(place_.y + place_.height - 1, int(std::ceil(high + kReach - 0.5)));
    for (int y = first; y <= last; ++y) {
      const Span span = spanBetween(p, y + 0.5 - kReach, y + 0.5 + kReach);
      if (!(span.low <= span.high)) continue;
      const int left = std::max(place_.x, int(std::floor(span.low - kReach - 0.5)));
      const int right =
          std::min(place_.x + place_.width - 1, int(std::ceil(span.high + kReach - 0.5)));
      for (int x = left; x <= right; ++x) {
        const Vec3 from = centre(x, y);
        const Vec3 w = nearestOnTriangle(from, p[0], p[1], p[2]);
        const Vec3 apart = w.x * p[0] + w.y * p[1] + w.z * p[2] - from;
        const double square = glm::dot(apart, apart);
        Nearest& cell = cells_[index(x, y)];
        if (square < cell.square || (cell.triangle == kNone && square <= cell.square)) {
          cell = {square, triangle};
        }
      }
    }
  }

 private:
  std::size_t index(int x, int y) const {
    return std::size_t(y - place_.y) * std::size_t(place_.width) + std::size_t(x - place_.x);
  }
  ChartPlace place_;
  std::vector<Nearest> cells_;
};

}  // namespace

Vec2 texelPlace(const Chart& chart, const ChartPlace& place, double texels_per_metre,
                const Vec3& p) {
  return Vec2(place.x, place.y) + double(kLightmapPadding) + texels_per_metre * chart.place(p);
}

void appendTexels(std::span<const FaceTriangle> triangles, const Chart& chart,
                  const ChartPlace& place, double texels_per_metre,
                  std::vector<ChartTexel>& texels) {
  const auto cornersOf = [&](Index t) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = Vec3(texelPlace(chart, place, texels_per_metre, triangles[t].position[k]), 0.0);
    }
    return p;
  };
  TexelGrid grid(place);
  for (const Index t : chart.triangles) grid.draw(t, cornersOf(t));
  constexpr double kInside = 1e-9;  // texels
  for (int y = place.y; y < place.y + place.height; ++y) {
    for (int x = place.x; x < place.x + place.width; ++x) {
      const Nearest& nearest = grid.at(x, y);
      if (nearest.triangle == kNone) continue;
      const std::array<Vec3, 3> p = cornersOf(nearest.triangle);
      const Vec3 w = nearestOnTriangle(grid.centre(x, y), p[0], p[1], p[2]);
      const std::array<Vec3, 3>& at = triangles[nearest.triangle].position;
      texels.push_back({x, y, nearest.triangle, nearest.square <= kInside * kInside,
                        w.x * at[0] + w.y * at[1] + w.z * at[2]});
    }
  }
}

}  // namespace radiosity
