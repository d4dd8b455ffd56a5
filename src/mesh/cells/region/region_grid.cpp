#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "base/geometry/segment.h"
#include "mesh/cells/region/region.h"

namespace radiosity {

namespace {

// The least distance of a point from a piece of the boundary, in grid spacings: nearer points would
// make flat triangles. Within this plus one spacing there is always a point.
constexpr double kClearance = 0.6;

struct FlatSegment {
  Vec2 a;
  Vec2 b;
};

/// Grid points (i, j), i along rows: origin + (i * step.x, j * step.y), in turned coordinates.
class Grid {
 public:
  /// `fine`: steps of at most `size`; else as near to it as possible.
  Grid(Vec2 lower, Vec2 upper, double size, bool fine) : lower_(lower) {
    for (int axis = 0; axis < 2; ++axis) {
      const double extent = upper[axis] - lower[axis];
      const double steps = std::max(1.0, fine ? std::ceil(extent / size * (1 - 1e-12))
                                              : std::round(extent / size * (1 + 1e-12)));
      step_[axis] = extent / steps;
      count_[axis] = long(steps) + 1;
    }
    state_.assign(std::size_t(count_[0] * count_[1]), 0);
  }

  Vec2 at(long i, long j) const { return lower_ + Vec2(double(i), double(j)) * step_; }
  long columns() const { return count_[0]; }
  long rows() const { return count_[1]; }
  double clearance() const { return kClearance * std::min(step_.x, step_.y); }

  /// Marks points too near to a segment.
  void block(const FlatSegment& s) {
    const double reach = clearance();
    const Vec2 low = (glm::min(s.a, s.b) - reach - lower_) / step_;
    const Vec2 high = (glm::max(s.a, s.b) + reach - lower_) / step_;
    for (long j = first(low.y); j <= last(high.y, 1); ++j) {
      for (long i = first(low.x); i <= last(high.x, 0); ++i) {
        if (squaredDistanceToSegment(at(i, j), s.a, s.b) < reach * reach)
          state_[index(i, j)] |= kBlocked;
      }
    }
  }

  /// Even-odd: a segment flips all points of the rows it crosses that lie to its right.
  void flipRightOf(const FlatSegment& s) {
    const Vec2& low = s.a.y <= s.b.y ? s.a : s.b;
    const Vec2& high = s.a.y <= s.b.y ? s.b : s.a;
    for (long j = first((low.y - lower_.y) / step_.y); j < rows(); ++j) {
      const double y = at(0, j).y;
      if (y >= high.y) break;
      if (y < low.y) continue;
      const double x = low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
      const double column = (x - lower_.x) / step_.x;
      // Points on the segment are blocked: rounding here cannot matter.
      for (long i = first(column) + (column >= 0 ? 1 : 0); i < columns(); ++i)
        state_[index(i, j)] ^= kInside;
    }
  }

  bool free(long i, long j) const { return state_[index(i, j)] == kInside; }

 private:
  static constexpr unsigned char kInside = 1;
  static constexpr unsigned char kBlocked = 2;
  std::size_t index(long i, long j) const { return std::size_t(j * count_[0] + i); }
  static long first(double x) { return std::max(0L, long(std::floor(x))); }
  long last(double x, int axis) const { return std::min(count_[axis] - 1, long(std::ceil(x))); }

  Vec2 lower_;
  Vec2 step_{0.0};
  long count_[2] = {0, 0};
  std::vector<unsigned char> state_;
};

}  // namespace

std::vector<Vec2> backgroundGrid(const Region& region) {
  const Vec2 u = region.along;
  const Vec2 v(-u.y, u.x);
  std::vector<Vec2> turned;
  turned.reserve(region.points.size());
  for (const Vec2& p : region.points) turned.emplace_back(glm::dot(p, u), glm::dot(p, v));
  Box2 box;
  for (const Vec2& p : turned) box.add(p);
  Grid grid(box.low, box.high, region.size, std::isfinite(region.longest));
  for (const auto& loop : region.loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const FlatSegment s{turned[loop[k]], turned[loop[(k + 1) % loop.size()]]};
      grid.block(s);
      grid.flipRightOf(s);
    }
  }
  for (const auto& [from, to] : region.inner) grid.block({turned[from], turned[to]});
  std::vector<Vec2> points;
  for (long j = 0; j < grid.rows(); ++j) {
    for (long k = 0; k < grid.columns(); ++k) {
      const long i = j % 2 == 0 ? k : grid.columns() - 1 - k;  // neighbours follow each other
      if (!grid.free(i, j)) continue;
      const Vec2 p = grid.at(i, j);
      points.push_back(p.x * u + p.y * v);
    }
  }
  return points;
}

}  // namespace radiosity
