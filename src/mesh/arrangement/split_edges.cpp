#include "mesh/arrangement/split_edges.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/union_find.h"
#include "mesh/arrangement/box_filter.h"

namespace radiosity {

namespace {

/// The closest points of two segments, if both lie inside them. Ericson, Real-Time Collision
/// Detection (2005), section 5.1.9; another test handles ends.
struct Approach {
  Vec3 on_first{0.0};
  Vec3 on_second{0.0};
};
std::optional<Approach> interiorApproach(const Vec3& p1, const Vec3& q1, const Vec3& p2,
                                         const Vec3& q2) {
  const Vec3 d1 = q1 - p1;
  const Vec3 d2 = q2 - p2;
  const Vec3 r = p1 - p2;
  const double a = glm::dot(d1, d1);
  const double b = glm::dot(d1, d2);
  const double c = glm::dot(d1, r);
  const double e = glm::dot(d2, d2);
  const double f = glm::dot(d2, r);
  const double determinant = a * e - b * b;
  if (!(determinant > 0)) return std::nullopt;
  const double s = (b * f - c * e) / determinant;
  const double t = (a * f - b * c) / determinant;
  if (!(s > 0 && s < 1 && t > 0 && t < 1)) return std::nullopt;
  return Approach{p1 + s * d1, p2 + t * d2};
}

class Splitter {
 public:
  Splitter(WeldedPoints& points, EdgeTable& edges) : points_(points), edges_(edges) {}

  /// Tests all pairs with an edge of `changed`; returns the edges that splitting made.
  std::vector<Index> pass(const std::vector<Index>& changed, Progress& progress);
  std::vector<Index> apply(const std::vector<ForcedSplit>& splits);
  std::vector<Index> apply(const Repairs& repairs);

 private:
  double coincidenceOf(const Edge& edge) const {
    return std::min(points_.radius(edge.a), points_.radius(edge.b));
  }
  std::vector<Index> edgesBeside(const std::vector<Index>& changed) const;
  bool isInside(Index vertex, const Edge& edge) const;
  std::optional<Approach> passOf(const Edge& f, const Edge& g) const;
  bool meet(Index first, Index second) const;
  void pair(Index first, Index second);

  WeldedPoints& points_;
  EdgeTable& edges_;
  std::vector<Box3> boxes_;  ///< by edge
  std::vector<ForcedSplit> splits_;
};

/// Whether a vertex is closer than coincidence to the edge and sees it under an obtuse angle. Both
/// parts are then shorter than the whole by a fixed amount, so that splitting ends. (Otherwise a
/// triangle of about one coincidence could split its sides for ever.)
bool Splitter::isInside(Index vertex, const Edge& edge) const {
  if (vertex == edge.a || vertex == edge.b) return false;
  const Vec3& p = points_[vertex];
  const Vec3 to_a = points_[edge.a] - p;
  const Vec3 to_b = points_[edge.b] - p;
  if (glm::dot(to_a, to_b) >= 0) return false;
  const double length = glm::distance(points_[edge.a], points_[edge.b]);
  const double reach = std::min(points_.radius(vertex), coincidenceOf(edge));
  return glm::length(glm::cross(to_a, to_b)) < reach * length;
}

/// The points where two edges without a common vertex pass each other closer than coincidence.
std::optional<Approach> Splitter::passOf(const Edge& f, const Edge& g) const {
  if (f.a == g.a || f.a == g.b || f.b == g.a || f.b == g.b) return std::nullopt;
  const auto approach = interiorApproach(points_[f.a], points_[f.b], points_[g.a], points_[g.b]);
  const double reach = std::min(coincidenceOf(f), coincidenceOf(g));
  if (!approach || glm::distance(approach->on_first, approach->on_second) >= reach) {
    return std::nullopt;
  }
  return approach;
}

/// Whether pair() would split one of the two edges.
bool Splitter::meet(Index first, Index second) const {
  const Edge& f = edges_[first];
  const Edge& g = edges_[second];
  return isInside(g.a, f) || isInside(g.b, f) || isInside(f.a, g) || isInside(f.b, g) ||
         passOf(f, g);
}

void Splitter::pair(Index first, Index second) {
  const Edge& f = edges_[first];
  const Edge& g = edges_[second];
  bool touch = false;
  const auto end = [&](Index edge, Index vertex) {
    if (!isInside(vertex, edges_[edge])) return;
    splits_.push_back({edge, vertex});
    touch = true;
  };
  end(first, g.a);
  end(first, g.b);
  end(second, f.a);
  end(second, f.b);
  if (touch) return;
  const auto approach = passOf(f, g);
  if (!approach) return;
  const Index vertex = points_.insert(0.5 * (approach->on_first + approach->on_second),
                                      std::min(coincidenceOf(f), coincidenceOf(g)));
  const auto cross = [&](Index edge, const Edge& ends) {
    const bool shortens =
        glm::dot(points_[ends.a] - points_[vertex], points_[ends.b] - points_[vertex]) < 0;
    if (vertex != ends.a && vertex != ends.b && shortens) splits_.push_back({edge, vertex});
  };
  cross(first, f);
  cross(second, g);
}

std::vector<Index> Splitter::apply(const std::vector<ForcedSplit>& splits) {
  std::map<Index, std::vector<Index>> by_edge;
  for (const ForcedSplit& s : splits) by_edge[s.edge].push_back(s.vertex);
  std::vector<Index> changed;
  for (auto& [edge, between] : by_edge) {
    const Vec3 a = points_[edges_[edge].a];
    const Vec3 along = points_[edges_[edge].b] - a;
    std::sort(between.begin(), between.end());
    between.erase(std::unique(between.begin(), between.end()), between.end());
    std::stable_sort(between.begin(), between.end(), [&](Index x, Index y) {
      return glm::dot(points_[x] - a, along) < glm::dot(points_[y] - a, along);
    });
    const auto parts = edges_.split(edge, between);
    changed.insert(changed.end(), parts.begin(), parts.end());
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

/// Merges first: a split may then be at an end of its edge, and is not needed.
std::vector<Index> Splitter::apply(const Repairs& repairs) {
  UnionFind together(points_.size());
  for (const auto& [v, w] : repairs.merges) together.unite(v, w);
  std::vector<Index> target(points_.size());
  for (Index v = 0; v < target.size(); ++v) {
    target[v] = together.find(v);
    if (target[v] != v) points_.retire(v);
  }
  std::vector<Index> changed = edges_.merge(target);
  std::vector<ForcedSplit> splits;
  for (const ForcedSplit& s : repairs.splits) {
    const Edge& edge = edges_[s.edge];
    const Index vertex = target[s.vertex];
    if (edge.alive() && vertex != edge.a && vertex != edge.b) splits.push_back({s.edge, vertex});
  }
  const std::vector<Index> split = apply(splits);
  changed.insert(changed.end(), split.begin(), split.end());
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  return changed;
}

std::vector<Index> Splitter::pass(const std::vector<Index>& changed, Progress& progress) {
  const std::size_t known = boxes_.size();
  boxes_.resize(edges_.size());
  parallelFor(edges_.size() - known, 1024, [&](std::size_t k) {
    const Index e = Index(known + k);
    Box3 box;
    box.add(points_[edges_[e].a]);
    box.add(points_[edges_[e].b]);
    boxes_[e] = box.grown(0.5 * coincidenceOf(edges_[e]));
  });
  const std::vector<Index> edge_of = edgesBeside(changed);
  std::vector<Box3> boxes;
  std::vector<Index> position(edges_.size(), kNone);
  for (const Index e : edge_of) {
    position[e] = Index(boxes.size());
    boxes.push_back(boxes_[e]);
  }
  std::vector<Index> some;
  for (const Index e : changed) {
    if (position[e] != kNone) some.push_back(position[e]);
  }
  splits_.clear();
  const auto met = [&](Index i, Index j) { return meet(edge_of[i], edge_of[j]); };
  for (const auto& [i, j] : overlappingPairs(boxes, some, &progress, met)) {
    pair(edge_of[i], edge_of[j]);
  }
  return apply(splits_);
}

/// The living edges, ascending, that may meet one of `changed`. A quick filter leaves out most of
/// those that are far from all of them.
std::vector<Index> Splitter::edgesBeside(const std::vector<Index>& changed) const {
  std::vector<Index> out;
  const auto gather = [&](const auto& may_meet) {
    for (Index e = 0; e < edges_.size(); ++e) {
      if (edges_[e].alive() && may_meet(e)) out.push_back(e);
    }
  };
  if (changed.size() == edges_.size()) {
    gather([](Index) { return true; });
    return out;
  }
  std::vector<Box3> near;
  near.reserve(changed.size());
  for (const Index e : changed) near.push_back(boxes_[e]);
  const BoxFilter filter(near);
  gather([&](Index e) { return filter.mayMeet(boxes_[e]); });
  return out;
}

}  // namespace

void splitEdges(WeldedPoints& points, EdgeTable& edges, const Repairs& repairs,
                Progress& progress) {
  Splitter splitter(points, edges);
  std::vector<Index> changed;
  if (repairs.empty()) {
    for (std::size_t e = 0; e < edges.size(); ++e) changed.push_back(Index(e));
  } else {
    changed = splitter.apply(repairs);
  }
  while (!changed.empty()) {
    progress.check();
    progress.begin("edges", changed.size());
    changed = splitter.pass(changed, progress);
    progress.end();
  }
}

}  // namespace radiosity
