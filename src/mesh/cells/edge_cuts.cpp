#include "mesh/cells/edge_cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/parallel.h"
#include "mesh/cells/four_sides.h"
#include "mesh/cells/sharp_corners.h"
#include "mesh/edge_key.h"

namespace radiosity {

namespace {

// A piece may be this much longer than the one next to it along a polygon's outline.
constexpr double kLargestStep = 3.0;
// Parts of a polygon narrower than this, in sizes, have no room for inner points that would
// separate the vertices on one side from far points on the other.
constexpr double kNarrow = 0.25;
// An edge hides a vertex if it is nearer than this share of the vertex's distance. An edge at
// nearly the same distance may start at the vertex.
constexpr double kHidden = 0.8;

}  // namespace

EdgeCuts::EdgeCuts(const CoarseComplex& complex) : complex_(complex) {
  const std::size_t polygons = complex.polygons.size();
  loops_.resize(polygons);
  four_sides_.resize(polygons);
  std::size_t sides = 0;
  for (const CoarsePolygon& polygon : complex.polygons) {
    for (const auto& loop : polygon.loops) sides += loop.size();
  }
  index_.reserve(sides / 2 + sides / 8);  // most edges have a polygon on each side
  for (std::size_t p = 0; p < polygons; ++p) {
    const CoarsePolygon& polygon = complex.polygons[p];
    for (const auto& loop : polygon.loops) {
      auto& edges = loops_[p].emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k) {
        edges.push_back(add(loop[k], loop[(k + 1) % loop.size()]));
      }
    }
    for (const auto& [from, to] : polygon.inner_edges) add(from, to);
    coincidence_.resize(ends_.size(), complex.coincidence);
    lowerCoincidence(p);
  }
  whole_.assign(ends_.size(), 0);
  classes_ = EdgeClasses(length_);
  parallelFor(polygons, 64, [&](std::size_t p) {
    const CoarsePolygon& polygon = complex.polygons[p];
    if (polygon.loops.size() != 1 || !polygon.inner_edges.empty()) return;
    four_sides_[p] = findFourSides(complex, polygon, loops_[p][0]);
  });
  for (const auto& four : four_sides_) {
    if (four) joinOpposite(*four);
  }
  classes_.orient();
  class_coincidence_ = coincidence_;
  for (Index e = 0; e < ends_.size(); ++e) {
    double& least = class_coincidence_[classes_.of(e)];
    least = std::min(least, coincidence_[e]);
  }
  limitAtSharpCorners();
}

/// An edge of several polygons has the least coincidence of theirs.
void EdgeCuts::lowerCoincidence(std::size_t polygon) {
  const CoarsePolygon& coarse = complex_.polygons[polygon];
  const auto lower = [&](DirectedEdge e) {
    coincidence_[e.edge] = std::min(coincidence_[e.edge], complex_.coincidenceOf(coarse));
  };
  for (const auto& loop : loops_[polygon]) std::ranges::for_each(loop, lower);
  for (const auto& [from, to] : coarse.inner_edges) lower(find(from, to));
}

DirectedEdge EdgeCuts::add(Index from, Index to) {
  const Index low = std::min(from, to);
  const Index high = std::max(from, to);
  const auto [place, is_new] = index_.try_emplace(edgeKey(low, high), Index(ends_.size()));
  if (is_new) {
    ends_.push_back({low, high});
    length_.push_back(glm::length(complex_.vertices[high] - complex_.vertices[low]));
  }
  return {place->second, from != low};
}

DirectedEdge EdgeCuts::find(Index from, Index to) const {
  return {index_.at(edgeKey(from, to)), from > to};
}

void EdgeCuts::joinOpposite(const FourSides& sides) {
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& side = sides.edges[k];
    const auto& opposite = sides.edges[k + 2];
    for (std::size_t i = 0; i < side.size(); ++i) {
      const DirectedEdge& a = side[i];
      const DirectedEdge& b = opposite[opposite.size() - 1 - i];
      // Around the loop opposite sides run in opposite directions.
      classes_.join(a.edge, b.edge, a.reversed == b.reversed);
    }
  }
}

/// Sets the least distance of points from a vertex that two edges leave at a small angle, so that
/// points on one do not lie on the other. The edges may belong to different polygons.
void EdgeCuts::limitAtSharpCorners() {
  least_start_.assign(ends_.size(), 0.0);
  const std::vector<double> sines = sharpestSines(complex_.vertices, ends_);
  for (Index e = 0; e < ends_.size(); ++e) {
    if (sines[e] >= 1) continue;
    const Index cls = classes_.of(e);
    const double scale = classes_.longest(cls) / length_[e];
    least_start_[cls] = std::max(least_start_[cls], 2 * coincidence_[e] / sines[e] * scale);
  }
}

void EdgeCuts::findOpposites(double largest) {
  opposites_.assign(ends_.size(), {});
  std::vector<PolygonEdge> edges;
  std::vector<DirectedEdge> names;
  for (std::size_t p = 0; p < loops_.size(); ++p) {
    // The sides of a grid may be arbitrarily near to each other.
    if (four_sides_[p]) continue;
    edges.clear();
    names.clear();
    const auto add_edge = [&](DirectedEdge e, bool both_sides) {
      const auto& ends = ends_[e.edge];
      edges.push_back({{ends[e.reversed ? 1 : 0], ends[e.reversed ? 0 : 1]}, both_sides});
      names.push_back(e);
    };
    const CoarsePolygon& polygon = complex_.polygons[p];
    for (const auto& loop : loops_[p]) {
      for (const DirectedEdge& e : loop) add_edge(e, false);
    }
    for (const auto& [from, to] : polygon.inner_edges) add_edge(find(from, to), true);
    std::vector<std::vector<Gap>> gaps(edges.size());
    forGaps(complex_.vertices, polygon.normal, edges, kNarrow * largest,
            [&](std::size_t k, const Gap& gap) { gaps[k].push_back(gap); });
    for (std::size_t k = 0; k < edges.size(); ++k) noteGaps(names[k], gaps[k]);
  }
  for (auto& list : opposites_) {
    std::sort(list.begin(), list.end(), [](const Opposite& a, const Opposite& b) {
      return a.gap < b.gap || (a.gap == b.gap && a.place < b.place);
    });
  }
}

/// Keeps the vertices at the ends of gaps that no other edge hides from this one.
void EdgeCuts::noteGaps(DirectedEdge edge, const std::vector<Gap>& gaps) {
  const double length = length_[edge.edge];
  const Index cls = classes_.of(edge.edge);
  const bool backwards = edge.reversed != classes_.opposed(edge.edge);
  const auto note = [&](double at, double width) {
    if (at <= 0 || at >= length || width <= 0) return;
    for (const Gap& g : gaps) {
      if (at < g.from || at > g.to || g.to <= g.from) continue;
      const double w = g.gap_from + (at - g.from) / (g.to - g.from) * (g.gap_to - g.gap_from);
      if (w > 0 && w < kHidden * width) return;
    }
    const double t = backwards ? 1 - at / length : at / length;
    opposites_[cls].push_back({t, width * (classes_.longest(cls) / length)});
    if (classes_.twisted(cls)) opposites_[cls].push_back({1 - t, opposites_[cls].back().gap});
  };
  for (const Gap& gap : gaps) {
    note(gap.from, gap.gap_from);
    note(gap.to, gap.gap_to);
  }
}

/// The cuts opposite of vertices. The narrowest gaps come first, since they need cuts most if there
/// is no room for all.
std::vector<double> EdgeCuts::stopsFor(Index cls, double size, double spacing) const {
  std::vector<double> stops;
  if (opposites_.empty()) return stops;
  const double length = classes_.longest(cls);
  // Points near a sharp corner would lie on its other edge.
  const double corner = least_start_[cls] / length;
  for (const Opposite& opposite : opposites_[cls]) {
    if (opposite.gap > kNarrow * size) break;
    const double room = std::max(spacing * opposite.gap, 4 * class_coincidence_[cls]) / length;
    const double margin = std::max(room, corner);
    if (opposite.place < margin || opposite.place > 1 - margin) continue;
    const auto next = std::lower_bound(stops.begin(), stops.end(), opposite.place);
    if (next != stops.end() && *next - opposite.place < room) continue;
    if (next != stops.begin() && opposite.place - *(next - 1) < room) continue;
    stops.insert(next, opposite.place);
  }
  return stops;
}

void EdgeCuts::keepWhole(std::size_t polygon) {
  for (const auto& loop : loops_[polygon]) {
    for (const DirectedEdge& e : loop) whole_[e.edge] = 1;
  }
  for (const auto& [from, to] : complex_.polygons[polygon].inner_edges) {
    whole_[find(from, to).edge] = 1;
  }
}

bool EdgeCuts::hasOpposites() const {
  return std::ranges::any_of(opposites_, [](const auto& list) { return !list.empty(); });
}

void EdgeCuts::countPieces(Rounding rounding) {
  double total = 0;
  for (Index e = 0; e < ends_.size(); ++e) {
    const Index cls = classes_.of(e);
    const double count =
        whole_[e] ? 1.0 : pieceCount(classes_.longest(cls), wanted_[cls], rounding);
    total += count;
    if (!(total <= kMostPatches)) {
      throw InputError(fmt::format(
          "patches of size {:g} m would cut the scene's edges into more than {:g} pieces; "
          "ask for fewer patches or a longer edge",
          wanted_[cls].size, kMostPatches));
    }
    pieces_[e] = std::size_t(count);
  }
}

bool EdgeCuts::isGrid(std::size_t polygon) const {
  if (!four_sides_[polygon]) return false;
  const auto count = [&](std::size_t side) {
    std::size_t sum = 0;
    for (const DirectedEdge& e : four_sides_[polygon]->edges[side]) sum += pieces_[e.edge];
    return sum;
  };
  return count(0) == count(2) && count(1) == count(3);
}

void EdgeCuts::wantAtEnd(DirectedEdge edge, bool at_last, double size) {
  const Index cls = classes_.of(edge.edge);
  const double scale = classes_.longest(cls) / length_[edge.edge];
  const double wanted = std::max(size * scale, least_start_[cls]);
  const bool at_end = at_last != (edge.reversed != classes_.opposed(edge.edge));
  EdgeSize& s = wanted_[cls];
  if (at_end || classes_.twisted(cls)) s.end = std::min(s.end, wanted);
  if (!at_end || classes_.twisted(cls)) s.start = std::min(s.start, wanted);
}

/// Edges without any cut are features themselves and stay whole.
void EdgeCuts::gradeTowardsShortPieces(Rounding rounding) {
  const auto pieceAt = [&](DirectedEdge e, bool at_last) {
    if (whole_[e.edge]) return length_[e.edge];
    const Index cls = classes_.of(e.edge);
    const auto ends =
        endPieces(classes_.longest(cls), wanted_[cls], double(pieces_[e.edge]), rounding);
    const bool at_end = at_last != (e.reversed != classes_.opposed(e.edge));
    return ends[at_end ? 1 : 0] * (length_[e.edge] / classes_.longest(cls));
  };
  for (std::size_t p = 0; p < loops_.size(); ++p) {
    if (isGrid(p)) continue;
    for (const auto& loop : loops_[p]) {
      for (std::size_t k = 0; k < loop.size(); ++k) {
        const DirectedEdge before = loop[k];
        const DirectedEdge after = loop[(k + 1) % loop.size()];
        const double a = pieceAt(before, true);
        const double b = pieceAt(after, false);
        if (pieces_[before.edge] > 1 && a > kLargestStep * b) wantAtEnd(before, true, b);
        if (pieces_[after.edge] > 1 && b > kLargestStep * a) wantAtEnd(after, false, a);
      }
    }
  }
}

void EdgeCuts::cut(double size, Rounding rounding, double spacing) {
  const std::size_t edges = ends_.size();
  pieces_.resize(edges);
  first_point_.resize(edges);
  wanted_.assign(edges, EdgeSize{size});
  for (Index e = 0; e < edges; ++e) {
    const double least = least_start_[classes_.of(e)];
    if (least > 0) wanted_[e].most_pieces = classes_.longest(classes_.of(e)) / least;
    wanted_[e].stops = stopsFor(e, size, spacing);
  }
  countPieces(rounding);
  gradeTowardsShortPieces(rounding);
  countPieces(rounding);
  edge_points_.clear();
  for (Index e = 0; e < edges; ++e) {
    first_point_[e] = edge_points_.size();
    if (whole_[e]) continue;
    const Index cls = classes_.of(e);
    const Vec3& a = complex_.vertices[ends_[e][classes_.opposed(e) ? 1 : 0]];
    const Vec3& b = complex_.vertices[ends_[e][classes_.opposed(e) ? 0 : 1]];
    for (const double t :
         cutFractions(classes_.longest(cls), wanted_[cls], double(pieces_[e]), rounding)) {
      edge_points_.push_back(a + (b - a) * t);
    }
    if (classes_.opposed(e)) {
      std::reverse(edge_points_.begin() + std::ptrdiff_t(first_point_[e]), edge_points_.end());
    }
  }
}

bool EdgeCuts::isUncut(std::size_t polygon) const {
  const auto is_whole = [&](DirectedEdge e) { return pieces_[e.edge] == 1; };
  return std::ranges::all_of(
             loops_[polygon],
             [&](const auto& loop) { return std::ranges::all_of(loop, is_whole); }) &&
         std::ranges::all_of(complex_.polygons[polygon].inner_edges,
                             [&](const auto& e) { return is_whole(find(e[0], e[1])); });
}

Vec3 EdgeCuts::point(Index id) const {
  const std::size_t vertices = complex_.vertices.size();
  return id < vertices ? complex_.vertices[id] : edge_points_[id - vertices];
}

void EdgeCuts::append(DirectedEdge edge, std::vector<Index>& ids) const {
  const Index e = edge.edge;
  ids.push_back(ends_[e][edge.reversed ? 1 : 0]);
  const Index first = Index(complex_.vertices.size() + first_point_[e]);
  const Index inside = Index(pieces_[e] - 1);
  for (Index k = 0; k < inside; ++k) {
    ids.push_back(first + (edge.reversed ? inside - 1 - k : k));
  }
}

}  // namespace radiosity
