#include "visibility/occluders/flat.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <tuple>

#include "mesh/cells/join_loops.h"
#include "visibility/elements/convex_pieces.h"
#include "visibility/occluders/hull.h"

namespace radiosity {
namespace {

bool liesOn(const OccluderPolygons& all, const OccluderPolygon& polygon,
            const OccluderPolygon& plane) {
  for (const std::vector<Index>& loop : polygon.loops) {
    for (const Index v : loop) {
      if (std::abs(glm::dot(plane.normal, all.vertices[v]) - plane.offset) > all.coincidence) {
        return false;
      }
    }
  }
  return true;
}

std::vector<Index> reversed(std::vector<Index> loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

/// Polygons joined to `seed` by edges, all on its plane; none already marked.
std::vector<Index> coplanarGroup(const OccluderPolygons& all, const OccluderEdgeUsers& edges,
                                 Index seed, std::vector<std::uint8_t>& taken) {
  std::vector<Index> group{seed};
  taken[seed] = 1;
  for (std::size_t k = 0; k < group.size() && all.polygons[seed].planar; ++k) {
    for (const std::vector<Index>& loop : all.polygons[group[k]].loops) {
      for (std::size_t c = 0; c < loop.size(); ++c) {
        const Index a = loop[c];
        const Index b = loop[(c + 1) % loop.size()];
        for (const OccluderEdge& edge : {OccluderEdge(a, b), OccluderEdge(b, a)}) {
          const auto users = edges.find(edge);
          if (users == edges.end()) continue;
          for (const Index p : users->second) {
            if (taken[p] || !liesOn(all, all.polygons[p], all.polygons[seed])) continue;
            taken[p] = 1;
            group.push_back(p);
          }
        }
      }
    }
  }
  return group;
}

/// Convex pieces of one plane, joined greedily.
class PieceMerger {
 public:
  PieceMerger(const OccluderPolygons& all, const Vec3& normal) : all_(all), normal_(normal) {}

  void add(std::vector<Index> loop, Index polygon) {
    std::vector<Index> key = loop;
    std::sort(key.begin(), key.end());
    // Two polygons back to back are one piece.
    const auto [same, added] = known_.try_emplace(std::move(key), pieces_.size());
    if (added) {
      pieces_.push_back({std::move(loop), normal_, {polygon}});
    } else {
      pieces_[same->second].polygons.push_back(polygon);
    }
  }

  std::vector<FlatPiece> merged() {
    while (mergeLongest()) {
    }
    std::vector<FlatPiece> out;
    for (FlatPiece& piece : pieces_) {
      if (piece.loop.empty()) continue;
      std::sort(piece.polygons.begin(), piece.polygons.end());
      piece.polygons.erase(std::unique(piece.polygons.begin(), piece.polygons.end()),
                           piece.polygons.end());
      out.push_back(std::move(piece));
    }
    return out;
  }

 private:
  /// Tries the pairs of pieces in the order of their common border; true if one pair was joined.
  bool mergeLongest() {
    std::map<OccluderEdge, Index> owner;
    for (Index p = 0; p < pieces_.size(); ++p) {
      const std::vector<Index>& loop = pieces_[p].loop;
      for (std::size_t k = 0; k < loop.size(); ++k) {
        owner.try_emplace({loop[k], loop[(k + 1) % loop.size()]}, p);
      }
    }
    std::map<std::pair<Index, Index>, double> borders;
    for (const auto& [edge, p] : owner) {
      const auto other = owner.find({edge.second, edge.first});
      if (other == owner.end() || other->second <= p) continue;
      borders[{p, other->second}] +=
          glm::distance(all_.vertices[edge.first], all_.vertices[edge.second]);
    }
    std::vector<std::tuple<double, Index, Index>> order;
    order.reserve(borders.size());
    for (const auto& [pair, length] : borders) order.emplace_back(-length, pair.first, pair.second);
    std::sort(order.begin(), order.end());
    bool any = false;
    std::vector<std::uint8_t> changed(pieces_.size(), 0);
    for (const auto& [length, p, q] : order) {
      if (changed[p] || changed[q]) continue;
      std::vector<Index> loop = unionOf(pieces_[p].loop, pieces_[q].loop);
      if (loop.empty()) continue;
      pieces_[p].loop = std::move(loop);
      pieces_[p].polygons.insert(pieces_[p].polygons.end(), pieces_[q].polygons.begin(),
                                 pieces_[q].polygons.end());
      pieces_[q].loop.clear();
      changed[p] = changed[q] = 1;
      any = true;
    }
    return any;
  }

  /// The outline of two pieces together; empty if it is no single convex loop.
  std::vector<Index> unionOf(const std::vector<Index>& a, const std::vector<Index>& b) const {
    std::vector<Index> loop = joinLoops(a, b);
    if (!loop.empty() && !isConvex(loop)) return {};
    return loop;
  }

  /// True if a loop turns one way, but for corners closer than the coincidence to their chord.
  bool isConvex(const std::vector<Index>& loop) const {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vec3& a = all_.vertices[loop[k]];
      const Vec3& b = all_.vertices[loop[(k + 1) % loop.size()]];
      const Vec3& c = all_.vertices[loop[(k + 2) % loop.size()]];
      const Vec3 chord = c - a;
      const double turn = glm::dot(glm::cross(b - a, chord), normal_);
      if (turn < -all_.coincidence * glm::length(chord)) return false;
    }
    return true;
  }

  const OccluderPolygons& all_;
  Vec3 normal_;
  std::vector<FlatPiece> pieces_;
  std::map<std::vector<Index>, std::size_t> known_;
};

/// The triangles of a polygon, or trapezoids on new vertices.
std::vector<std::vector<Index>> convexParts(OccluderPolygons& all, const OccluderPolygon& polygon) {
  std::vector<std::vector<Index>> parts;
  for (const auto& t : all.trianglesOf(polygon)) parts.emplace_back(t.begin(), t.end());
  if (!parts.empty()) return parts;
  std::vector<std::vector<Vec3>> loops;
  for (const std::vector<Index>& loop : polygon.loops) {
    std::vector<Vec3>& corners = loops.emplace_back();
    for (const Index v : loop) corners.push_back(all.vertices[v]);
  }
  for (const auto& corners : convexPieces(loops, polygon.normal, all.coincidence)) {
    std::vector<Index>& part = parts.emplace_back();
    for (const Vec3& corner : corners) {
      part.push_back(Index(all.vertices.size()));
      all.vertices.push_back(corner);
    }
  }
  return parts;
}

}  // namespace

std::vector<FlatPiece> flatPieces(OccluderPolygons& all, const std::vector<std::uint8_t>& taken,
                                  Progress& progress) {
  const OccluderEdgeUsers edges = all.edgeUsers();
  std::vector<std::uint8_t> done = taken;
  std::vector<FlatPiece> out;
  for (Index seed = 0; seed < all.polygons.size(); ++seed) {
    if (done[seed]) continue;
    progress.check();
    const Vec3 normal = all.polygons[seed].normal;
    PieceMerger merger(all, normal);
    for (const Index p : coplanarGroup(all, edges, seed, done)) {
      const OccluderPolygon& polygon = all.polygons[p];
      const bool same_way = glm::dot(polygon.normal, normal) > 0;
      if (polygon.convex) {
        merger.add(same_way ? polygon.loops[0] : reversed(polygon.loops[0]), p);
        continue;
      }
      for (std::vector<Index>& loop : convexParts(all, polygon)) {
        merger.add(same_way ? loop : reversed(std::move(loop)), p);
      }
    }
    std::vector<FlatPiece> pieces = merger.merged();
    std::move(pieces.begin(), pieces.end(), std::back_inserter(out));
  }
  return out;
}

bool makeFlatOccluder(const OccluderPolygons& all, const FlatPiece& piece, Occluder& occluder) {
  const std::vector<Index> loop =
      planarHull(all.vertices, piece.loop, piece.normal, all.coincidence);
  if (loop.size() < 3) return false;
  // Puts the corners on one plane, at the mean of their offsets, if a patch is not quite planar.
  double offset = 0;
  for (const Index v : loop) {
    offset += glm::dot(piece.normal, all.vertices[v]) / double(loop.size());
  }
  for (const Index v : loop) {
    const Vec3& p = all.vertices[v];
    occluder.corners.push_back(p + (offset - glm::dot(piece.normal, p)) * piece.normal);
  }
  occluder.planes = {{piece.normal, offset}, {-piece.normal, -offset}};
  for (Index k = 0; k < loop.size(); ++k) {
    occluder.edges.push_back({k, Index((k + 1) % loop.size()), 0, 1});
  }
  occluder.flat = true;
  boundOccluder(occluder);
  return true;
}

}  // namespace radiosity
