#include "blockers.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "convex_pieces.h"

namespace radiosity::truth {
namespace {

/// Everything within `slack` of one side of the plane, or beyond.
template <class Points>
bool oneSided(const Points& points, const Vec3& normal, double offset, double slack) {
  bool above = false;
  bool below = false;
  for (const Vec3& p : points) {
    const double height = glm::dot(normal, p) - offset;
    above = above || height > slack;
    below = below || height < -slack;
  }
  return !(above && below);
}

template <class Points>
bool allBelow(const Points& points, const Vec3& normal, double offset, double slack) {
  return std::all_of(points.begin(), points.end(),
                     [&](const Vec3& p) { return glm::dot(normal, p) - offset <= slack; });
}

}  // namespace

Sheet::Sheet(const Loop& corners)
    : loop(corners), normal(glm::normalize(vectorArea(corners))), middle(middleOf(corners)) {
  offset = glm::dot(normal, middle);
  radius = reach(loop, middle);
}

BlockerSet::BlockerSet(const PatchMesh& mesh, const std::vector<Vec3>& vertices, double coincidence)
    : coincidence_(coincidence) {
  const PlanarPolygons& polygons = mesh.polygons;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const Vec3& some = vertices[polygons.loop(polygons.loopBegin(p))[0]];
    const double offset = glm::dot(polygons.normal[p], some);
    if (oneSided(vertices, polygons.normal[p], offset, coincidence)) continue;
    for (const Loop& piece : convexPieces(polygons, p, vertices)) {
      const Sheet sheet(piece);
      blockers_.push_back({piece, sheet.normal, sheet.offset, 0});
    }
  }
  joinBodies();
  if (blockers_.empty()) return;
  nodes_.emplace_back();
  buildNode(0, 0, std::uint32_t(blockers_.size()));
}

void BlockerSet::joinBodies() {
  std::vector<Index> parent(blockers_.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](Index k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  std::map<std::tuple<double, double, double>, Index> owner;
  for (Index k = 0; k < blockers_.size(); ++k) {
    for (const Vec3& p : blockers_[k].loop) {
      const auto [found, is_new] = owner.try_emplace({p.x, p.y, p.z}, k);
      if (!is_new) parent[root(k)] = root(found->second);
    }
  }
  for (Index k = 0; k < blockers_.size(); ++k) blockers_[k].body = root(k);
}

void BlockerSet::buildNode(std::uint32_t node, std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeaf = 3;
  Vec3 low(std::numeric_limits<double>::max());
  Vec3 high(-std::numeric_limits<double>::max());
  for (std::uint32_t k = first; k < first + count; ++k) {
    for (const Vec3& p : blockers_[k].loop) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  nodes_[node] = {low, high, first, count};
  if (count <= kLeaf) return;
  const Vec3 size = high - low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto begin = blockers_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](const Blocker& a, const Blocker& b) {
                     return middleOf(a.loop)[axis] < middleOf(b.loop)[axis];
                   });
  const auto children = std::uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  nodes_[node].count = 0;
  buildNode(children, first, count / 2);
  buildNode(children + 1, first + count / 2, count - count / 2);
}

/// Planes that have both sheets on one side: what has no point beyond any one of them lies outside
/// the convex hull of the two, and cannot come between. Touching counts as outside.
std::vector<BlockerSet::Plane> BlockerSet::shaft(const Sheet& a, const Sheet& b) const {
  std::vector<Plane> planes = {{a.normal, a.offset + coincidence_},
                               {b.normal, b.offset + coincidence_}};
  const double slack = 1e-6 * coincidence_;  // rounding of coordinates of the scene's size
  const auto support = [&](const Loop& edges, const Loop& points) {
    for (std::size_t k = 0; k < edges.size(); ++k) {
      const Vec3 along = edges.next(k) - edges[k];
      for (const Vec3& p : points) {
        Vec3 normal = glm::cross(along, p - edges[k]);
        const double length = glm::length(normal);
        if (!(length > 1e-9 * glm::length(along) * glm::distance(p, edges[k]))) continue;
        normal /= length;
        const double offset = glm::dot(normal, edges[k]);
        if (allBelow(edges, normal, offset, slack) && allBelow(points, normal, offset, slack)) {
          planes.push_back({-normal, -offset + slack});
        }
        if (allBelow(edges, -normal, -offset, slack) && allBelow(points, -normal, -offset, slack)) {
          planes.push_back({normal, offset + slack});
        }
      }
    }
  };
  support(a.loop, b.loop);
  support(b.loop, a.loop);
  return planes;
}

std::vector<const Blocker*> BlockerSet::between(const Sheet& a, const Sheet& b) const {
  std::vector<const Blocker*> found;
  if (nodes_.empty()) return found;
  const std::vector<Plane> planes = shaft(a, b);
  const auto boxOutside = [&](const Node& node) {
    return std::any_of(planes.begin(), planes.end(), [&](const Plane& plane) {
      double most = -plane.offset;
      for (int axis = 0; axis < 3; ++axis) {
        const double n = plane.normal[axis];
        most += n * (n > 0 ? node.high : node.low)[axis];
      }
      return most <= 0;
    });
  };
  const auto blocks = [&](const Blocker& blocker) {
    for (const Plane& plane : planes) {
      if (allBelow(blocker.loop, plane.normal, plane.offset, 0.0)) return false;
    }
    // Nothing gets across a plane that has both ends on one side.
    const auto below = [&](const Vec3& normal, double offset) {
      return allBelow(a.loop, normal, offset, coincidence_) &&
             allBelow(b.loop, normal, offset, coincidence_);
    };
    return !below(blocker.normal, blocker.offset) && !below(-blocker.normal, -blocker.offset);
  };
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (boxOutside(node)) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      if (blocks(blockers_[k])) found.push_back(&blockers_[k]);
    }
  }
  return found;
}

}  // namespace radiosity::truth
