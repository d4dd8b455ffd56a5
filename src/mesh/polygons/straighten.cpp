#include "mesh/polygons/straighten.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <tuple>

namespace radiosity {

namespace {

class Straightener {
 public:
  Straightener(const WeldedPoints& points, const std::vector<std::array<Index, 2>>& edges,
               const EdgeUses& uses, const std::vector<bool>& keep)
      : points_(points),
        edges_(edges),
        uses_(uses),
        keep_(keep),
        at_(points.size()),
        done_(edges.size(), false) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (const Index v : edges[e]) at_[v].push_back(Index(e));
    }
    out_.edge_of.assign(edges.size(), kNone);
    out_.removed.assign(points.size(), false);
  }

  StraightEdges run() {
    // First the chains between vertices where other edges meet, then the rings that are left.
    for (std::size_t v = 0; v < at_.size(); ++v) {
      if (at_[v].empty() || !endsChain(Index(v))) continue;
      for (const Index e : at_[v]) {
        if (!done_[e]) shorten(chain(Index(v), e));
      }
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (!done_[e]) shortenRing(Index(e));
    }
    return out_;
  }

 private:
  struct Chain {
    std::vector<Index> vertices;
    std::vector<Index> edges;
  };

  /// Whether a chain ends at a vertex: other edges meet there, it is kept, or the uses of the two
  /// edges differ.
  bool endsChain(Index v) const {
    return at_[v].size() != 2 || keep_[v] ||
           !std::ranges::equal(uses_.of(at_[v][0]), uses_.of(at_[v][1]));
  }

  Chain chain(Index start, Index edge) {
    Chain out{{start}, {}};
    for (;;) {
      done_[edge] = true;
      const Index from = out.vertices.back();
      const Index to = edges_[edge][0] == from ? edges_[edge][1] : edges_[edge][0];
      out.vertices.push_back(to);
      out.edges.push_back(edge);
      if (to == start || endsChain(to)) return out;
      edge = at_[to][0] == edge ? at_[to][1] : at_[to][0];
    }
  }

  /// Whether the chain from `begin` to `end` is straight: it advances along its chord and stays
  /// within coincidence of it.
  bool isStraight(const std::vector<Index>& v, std::size_t begin, std::size_t end) const {
    const Vec3& a = points_[v[begin]];
    const Vec3 chord = points_[v[end]] - a;
    const double length = glm::length(chord);
    double reached = 0;
    for (std::size_t k = begin + 1; k < end; ++k) {
      const Vec3 d = points_[v[k]] - a;
      const double along = glm::dot(d, chord);
      if (along <= reached || along >= length * length) return false;
      const double reach =
          std::min({points_.radius(v[k]), points_.radius(v[begin]), points_.radius(v[end])});
      if (glm::length(glm::cross(d, chord)) >= reach * length) return false;
      reached = along;
    }
    return true;
  }

  void shorten(const Chain& chain) {
    const auto& v = chain.vertices;
    std::size_t begin = 0;
    while (begin + 1 < v.size()) {
      std::size_t end = begin + 1;
      while (end + 1 < v.size() && isStraight(v, begin, end + 1)) ++end;
      for (std::size_t k = begin; k < end; ++k)
        out_.edge_of[chain.edges[k]] = Index(out_.edges.size());
      for (std::size_t k = begin + 1; k < end; ++k) out_.removed[v[k]] = true;
      out_.edges.push_back({v[begin], v[end]});
      begin = end;
    }
  }

  /// Shortens a ring. It has no end, so we begin at the first corner that is not straight.
  void shortenRing(Index edge) {
    Chain ring = chain(edges_[edge][0], edge);
    ring.vertices.pop_back();
    const std::size_t n = ring.vertices.size();
    std::size_t first = n;
    for (std::size_t k = 0; k < n; ++k) {
      const std::vector<Index> corner{ring.vertices[(k + n - 1) % n], ring.vertices[k],
                                      ring.vertices[(k + 1) % n]};
      if (isStraight(corner, 0, 2)) continue;
      if (first == n || ring.vertices[k] < ring.vertices[first]) first = k;
    }
    if (first == n) first = 0;
    const auto turn = std::ptrdiff_t(first);
    std::rotate(ring.vertices.begin(), ring.vertices.begin() + turn, ring.vertices.end());
    std::rotate(ring.edges.begin(), ring.edges.begin() + turn, ring.edges.end());
    ring.vertices.push_back(ring.vertices.front());
    shorten(ring);
  }

  const WeldedPoints& points_;
  const std::vector<std::array<Index, 2>>& edges_;
  const EdgeUses& uses_;
  const std::vector<bool>& keep_;
  std::vector<std::vector<Index>> at_;
  std::vector<bool> done_;
  StraightEdges out_;
};

}  // namespace

StraightEdges straighten(const WeldedPoints& points, const std::vector<std::array<Index, 2>>& edges,
                         const EdgeUses& uses, const std::vector<bool>& keep) {
  return Straightener(points, edges, uses, keep).run();
}

}  // namespace radiosity
