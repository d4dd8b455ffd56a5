#include "visibility/elements/convex_pieces.h"

#include <algorithm>
#include <map>
#include <utility>

namespace radiosity {
namespace {

/// An edge that climbs from one level to a higher one.
struct Climb {
  Vec2 low, high;
  std::size_t low_level, high_level;
};

/// The distinct heights of the corners, ascending: the first of each run within coincidence.
std::vector<double> levelsOf(const std::vector<std::vector<Vec2>>& loops, double coincidence) {
  std::vector<double> heights;
  for (const auto& loop : loops) {
    for (const Vec2& corner : loop) heights.push_back(corner.y);
  }
  std::sort(heights.begin(), heights.end());
  std::vector<double> levels;
  for (const double height : heights) {
    if (levels.empty() || height - levels.back() > coincidence) levels.push_back(height);
  }
  return levels;
}

std::vector<Climb> climbsOf(const std::vector<std::vector<Vec2>>& loops,
                            const std::vector<double>& levels) {
  const auto level = [&](double height) {
    return std::size_t(std::upper_bound(levels.begin(), levels.end(), height) - levels.begin()) - 1;
  };
  std::vector<Climb> climbs;
  for (const auto& loop : loops) {
    for (std::size_t k = 0, last = loop.size() - 1; k < loop.size(); last = k++) {
      Climb climb{loop[last], loop[k], level(loop[last].y), level(loop[k].y)};
      if (climb.low_level == climb.high_level) continue;
      if (climb.low_level > climb.high_level) {
        std::swap(climb.low, climb.high);
        std::swap(climb.low_level, climb.high_level);
      }
      climbs.push_back(climb);
    }
  }
  return climbs;
}

/// The point of the edge at a level: its own corner at its ends.
Vec2 at(const Climb& climb, std::size_t level, double height) {
  if (level == climb.low_level) return climb.low;
  if (level == climb.high_level) return climb.high;
  const double t = (height - climb.low.y) / (climb.high.y - climb.low.y);
  return {climb.low.x + (climb.high.x - climb.low.x) * t, height};
}

/// Trapezoids between two edges, from one level to another.
class Trapezoids {
 public:
  Trapezoids(const std::vector<Climb>& climbs, const std::vector<double>& levels)
      : climbs_(climbs), levels_(levels) {}

  /// `edges`: pairs, in the slab above `level`, with inside between them. Trapezoids between edges
  /// that were neighbours in the slab below as well go on; the others end.
  void addSlab(std::size_t level, const std::vector<std::size_t>& edges) {
    std::map<Sides, std::size_t> now;
    for (std::size_t k = 0; k + 1 < edges.size(); k += 2) {
      const Sides sides(edges[k], edges[k + 1]);
      const auto before = open_.find(sides);
      now[sides] = before == open_.end() ? level : before->second;
      if (before != open_.end()) open_.erase(before);
    }
    endAll(level);
    open_ = std::move(now);
  }
  std::vector<std::vector<Vec2>> finish() {
    endAll(levels_.size() - 1);
    return std::move(pieces_);
  }

 private:
  using Sides = std::pair<std::size_t, std::size_t>;  // left, right

  void endAll(std::size_t top) {
    for (const auto& [sides, bottom] : open_) {
      const Climb& left = climbs_[sides.first];
      const Climb& right = climbs_[sides.second];
      std::vector<Vec2> piece = {at(left, bottom, levels_[bottom]),
                                 at(right, bottom, levels_[bottom]), at(right, top, levels_[top]),
                                 at(left, top, levels_[top])};
      piece.erase(std::unique(piece.begin(), piece.end()), piece.end());
      if (piece.size() > 1 && piece.front() == piece.back()) piece.pop_back();
      if (piece.size() > 2) pieces_.push_back(std::move(piece));
    }
    open_.clear();
  }

  const std::vector<Climb>& climbs_;
  const std::vector<double>& levels_;
  std::map<Sides, std::size_t> open_;  // with the level they began at
  std::vector<std::vector<Vec2>> pieces_;
};

}  // namespace

std::vector<std::vector<Vec3>> polygonLoops(const PatchMesh& mesh, std::size_t polygon,
                                            const Vec3& middle, double scale) {
  const PlanarPolygons& polygons = mesh.polygons;
  std::vector<std::vector<Vec3>> loops;
  for (std::size_t l = polygons.loopBegin(polygon); l < polygons.loopEnd(polygon); ++l) {
    std::vector<Vec3>& loop = loops.emplace_back();
    for (const Index v : polygons.loop(l)) loop.push_back((mesh.vertices[v] - middle) * scale);
  }
  return loops;
}

PlaneFrame polygonFrame(const std::vector<std::vector<Vec3>>& loops, const Vec3& normal) {
  // An edge wins only if it is longer by more than rounding: a turned square keeps its first.
  constexpr double kClearlyLonger = 1 + 1e-9;
  double longest = 0;
  Vec3 along = axisAcross(normal);
  for (const auto& loop : loops) {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3 edge = loop[(k + 1) % loop.size()] - loop[k];
      const double length = glm::length(edge);
      if (length <= longest * kClearlyLonger) continue;
      longest = length;
      along = edge;
    }
  }
  return makeFrame(loops.empty() ? Vec3(0.0) : loops.front().front(), normal, along);
}

std::vector<std::vector<Vec2>> convexPieces(const std::vector<std::vector<Vec2>>& loops,
                                            double coincidence) {
  const std::vector<double> levels = levelsOf(loops, coincidence);
  if (levels.size() < 2) return {};
  const std::vector<Climb> climbs = climbsOf(loops, levels);
  std::vector<std::vector<std::size_t>> from_level(levels.size());
  for (std::size_t k = 0; k < climbs.size(); ++k) from_level[climbs[k].low_level].push_back(k);
  std::vector<std::size_t> active;
  Trapezoids trapezoids(climbs, levels);
  for (std::size_t level = 0; level + 1 < levels.size(); ++level) {
    const double middle = 0.5 * (levels[level] + levels[level + 1]);
    std::vector<std::pair<double, std::size_t>> crossing;
    std::erase_if(active, [&](std::size_t k) { return climbs[k].high_level <= level; });
    active.insert(active.end(), from_level[level].begin(), from_level[level].end());
    crossing.reserve(active.size());
    for (const std::size_t k : active) {
      crossing.emplace_back(at(climbs[k], levels.size(), middle).x, k);
    }
    std::sort(crossing.begin(), crossing.end());
    std::vector<std::size_t> edges;
    edges.reserve(crossing.size());
    for (const auto& [x, k] : crossing) edges.push_back(k);
    trapezoids.addSlab(level, edges);
  }
  return trapezoids.finish();
}

std::vector<std::vector<Vec3>> convexPieces(const std::vector<std::vector<Vec3>>& loops,
                                            const Vec3& normal, double coincidence) {
  const PlaneFrame frame = polygonFrame(loops, normal);
  std::vector<std::vector<Vec2>> flat;
  for (const auto& loop : loops) {
    std::vector<Vec2>& out = flat.emplace_back();
    for (const Vec3& corner : loop) out.push_back(frame.flat(corner));
  }
  std::vector<std::vector<Vec3>> pieces;
  for (const auto& piece : convexPieces(flat, coincidence)) {
    std::vector<Vec3>& out = pieces.emplace_back();
    for (const Vec2& corner : piece) out.push_back(frame.lift(corner));
  }
  return pieces;
}

}  // namespace radiosity
