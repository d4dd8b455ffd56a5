#include "mesh/edge_cuts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mesh/edge_key.h"
#include "mesh/four_sides.h"

namespace radiosity {

namespace {

// Chains of quadrilaterals that widen or narrow (the rings of a sphere) are cut alike only as long
// as the lengths stay within this factor: beyond, one end of the chain would be far too fine.
constexpr double kLargestRatioInClass = 2.0;

}  // namespace

EdgeCuts::EdgeCuts(const CoarseComplex& complex) : complex_(complex) {
  const std::size_t polygons = complex.polygons.size();
  loops_.resize(polygons);
  four_sides_.resize(polygons);
  for (std::size_t p = 0; p < polygons; ++p) {
    const CoarsePolygon& polygon = complex.polygons[p];
    for (const auto& loop : polygon.loops) {
      auto& edges = loops_[p].emplace_back();
      for (std::size_t k = 0; k < loop.size(); ++k) {
        edges.push_back(add(loop[k], loop[(k + 1) % loop.size()]));
      }
    }
    for (const auto& [from, to] : polygon.inner_edges) add(from, to);
  }
  classes_ = UnionFind(ends_.size());
  class_shortest_ = class_longest_ = length_;
  for (std::size_t p = 0; p < polygons; ++p) {
    const CoarsePolygon& polygon = complex.polygons[p];
    if (polygon.loops.size() != 1 || !polygon.inner_edges.empty()) continue;
    four_sides_[p] = findFourSides(complex, polygon.loops[0], loops_[p][0]);
    if (four_sides_[p]) joinOpposite(*four_sides_[p]);
  }
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

void EdgeCuts::join(Index a, Index b) {
  a = classes_.find(a);
  b = classes_.find(b);
  const double shortest = std::min(class_shortest_[a], class_shortest_[b]);
  const double longest = std::max(class_longest_[a], class_longest_[b]);
  if (longest > kLargestRatioInClass * shortest) return;
  classes_.unite(a, b);
  class_shortest_[classes_.find(a)] = shortest;
  class_longest_[classes_.find(a)] = longest;
}

void EdgeCuts::joinOpposite(const FourSides& sides) {
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& side = sides.edges[k];
    const auto& opposite = sides.edges[k + 2];
    for (std::size_t i = 0; i < side.size(); ++i) {
      join(side[i].edge, opposite[opposite.size() - 1 - i].edge);
    }
  }
}

void EdgeCuts::cut(double size, Rounding rounding) {
  const std::size_t edges = ends_.size();
  pieces_.resize(edges);
  first_point_.resize(edges);
  double total = 0;
  for (Index e = 0; e < edges; ++e) {
    // A length that is a multiple of `size` but for rounding must not get a piece more.
    const double ratio = class_longest_[classes_.find(e)] / size;
    const double count = rounding == Rounding::at_most ? std::ceil(ratio * (1 - 1e-12))
                                                       : std::round(ratio * (1 + 1e-12));
    total += std::max(1.0, count);
    if (!(total <= kMostPatches)) {
      throw InputError(fmt::format(
          "patches of size {:g} m would cut the scene's edges into more than {:g} pieces; "
          "ask for fewer patches or a longer edge",
          size, kMostPatches));
    }
    pieces_[e] = std::size_t(std::max(1.0, count));
  }
  edge_points_.clear();
  for (Index e = 0; e < edges; ++e) {
    first_point_[e] = edge_points_.size();
    const Vec3& a = complex_.vertices[ends_[e][0]];
    const Vec3 along = complex_.vertices[ends_[e][1]] - a;
    for (std::size_t k = 1; k < pieces_[e]; ++k) {
      edge_points_.push_back(a + along * (double(k) / double(pieces_[e])));
    }
  }
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
