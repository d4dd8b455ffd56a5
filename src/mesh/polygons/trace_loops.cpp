#include "mesh/polygons/trace_loops.h"

#include <cmath>
#include <map>
#include <numbers>

namespace radiosity {

namespace {

class Tracer {
 public:
  Tracer(const WeldedPoints& points, const PlaneImage& frame,
         const std::vector<std::array<Index, 2>>& edges)
      : points_(points), frame_(frame), edges_(edges), used_(edges.size(), false) {
    for (std::size_t e = 0; e < edges.size(); ++e) leaving_[edges[e][0]].push_back(Index(e));
  }

  std::vector<std::vector<Index>> run() {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (!used_[e]) trace(Index(e));
    }
    return loops_;
  }

 private:
  /// The clockwise turn at `at` from the direction of `back` to that of `to`, in (0, 2 pi]. The
  /// inside lies in between.
  double turn(Index back, Index at, Index to) const {
    const Vec2 o = frame_(points_[at]);
    const Vec2 b = frame_(points_[back]) - o;
    const Vec2 t = frame_(points_[to]) - o;
    const double left = std::atan2(b.x * t.y - b.y * t.x, b.x * t.x + b.y * t.y);
    return left < 0 ? -left : 2.0 * std::numbers::pi - left;
  }

  Index next(Index edge) const {
    Index best = kNone;
    double best_turn = 0;
    for (const Index e : leaving_.at(edges_[edge][1])) {
      if (used_[e]) continue;
      const double t = turn(edges_[edge][0], edges_[edge][1], edges_[e][1]);
      if (best == kNone || t < best_turn) {
        best = e;
        best_turn = t;
      }
    }
    return best;
  }

  /// Follows the border around the inside. Whenever it returns to a vertex, the part in between is
  /// a loop.
  void trace(Index edge) {
    std::vector<Index> path;
    std::map<Index, std::size_t> position;
    while (edge != kNone) {
      used_[edge] = true;
      position[edges_[edge][0]] = path.size();
      path.push_back(edges_[edge][0]);
      const auto again = position.find(edges_[edge][1]);
      if (again != position.end()) {
        const auto begin = path.begin() + std::ptrdiff_t(again->second);
        loops_.emplace_back(begin, path.end());
        path.erase(begin, path.end());
        for (const Index v : loops_.back()) position.erase(v);
        if (path.empty()) return;
      }
      edge = next(edge);
    }
  }

  const WeldedPoints& points_;
  const PlaneImage& frame_;
  const std::vector<std::array<Index, 2>>& edges_;
  std::vector<bool> used_;
  std::map<Index, std::vector<Index>> leaving_;
  std::vector<std::vector<Index>> loops_;
};

}  // namespace

std::vector<std::vector<Index>> traceLoops(const WeldedPoints& points, const PlaneImage& frame,
                                           const std::vector<std::array<Index, 2>>& edges) {
  return Tracer(points, frame, edges).run();
}

}  // namespace radiosity
