#include "blockers.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "convex_pieces.h"

namespace radiosity::truth {
namespace {

using Key = std::tuple<double, double, double>;
Key keyOf(const Vec3& p) { return {p.x, p.y, p.z}; }

bool oneSided(const std::vector<Vec3>& points, const Vec3& normal, double offset, double slack) {
  bool above = false;
  bool below = false;
  for (const Vec3& p : points) {
    const double height = glm::dot(normal, p) - offset;
    above = above || height > slack;
    below = below || height < -slack;
  }
  return !(above && below);
}

/// Every edge of the pieces is there once in each direction.
bool isClosed(const std::vector<const Blocker*>& pieces) {
  std::map<std::pair<Key, Key>, int> uses;
  for (const Blocker* piece : pieces) {
    for (std::size_t k = 0; k < piece->loop.size(); ++k) {
      ++uses[{keyOf(piece->loop[k]), keyOf(piece->loop.next(k))}];
    }
  }
  return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    const auto back = uses.find({use.first.second, use.first.first});
    return use.second == 1 && back != uses.end() && back->second == 1;
  });
}

bool isConvexOutward(const std::vector<const Blocker*>& pieces, double slack) {
  for (const Blocker* face : pieces) {
    for (const Blocker* other : pieces) {
      for (const Vec3& p : other->loop) {
        if (glm::dot(face->normal, p) > face->offset + slack) return false;
      }
    }
  }
  return true;
}

bool holds(const std::vector<const Blocker*>& pieces, const Vec3& p, double slack) {
  return std::all_of(pieces.begin(), pieces.end(), [&](const Blocker* face) {
    return glm::dot(face->normal, p) < face->offset - slack;
  });
}

}  // namespace

BlockerSet::BlockerSet(const PatchMesh& mesh, const std::vector<Vec3>& vertices,
                       double coincidence) {
  const PlanarPolygons& polygons = mesh.polygons;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const Vec3& some = vertices[polygons.loop(polygons.loopBegin(p))[0]];
    const double offset = glm::dot(polygons.normal[p], some);
    if (oneSided(vertices, polygons.normal[p], offset, coincidence)) continue;
    for (const Loop& piece : convexPieces(polygons, p, vertices)) blockers_.emplace_back(piece);
  }
  joinBodies();
  findSolids(vertices, coincidence);
  if (blockers_.empty()) return;
  nodes_.emplace_back();
  buildNode(0, 0, std::uint32_t(blockers_.size()));
}

std::size_t BlockerSet::solids() const {
  return std::size_t(
      std::count_if(blockers_.begin(), blockers_.end(), [](const Blocker& b) { return b.solid; }));
}

void BlockerSet::joinBodies() {
  std::vector<Index> parent(blockers_.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](Index k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  std::map<Key, Index> owner;
  for (Index k = 0; k < blockers_.size(); ++k) {
    for (const Vec3& p : blockers_[k].loop) {
      const auto [found, is_new] = owner.try_emplace(keyOf(p), k);
      if (!is_new) parent[root(k)] = root(found->second);
    }
  }
  for (Index k = 0; k < blockers_.size(); ++k) blockers_[k].body = root(k);
}

void BlockerSet::findSolids(const std::vector<Vec3>& vertices, double coincidence) {
  std::map<Index, std::vector<const Blocker*>> bodies;
  for (const Blocker& blocker : blockers_) bodies[blocker.body].push_back(&blocker);
  std::vector<std::uint8_t> solid(blockers_.size(), 0);
  for (const auto& [body, pieces] : bodies) {
    solid[body] = isClosed(pieces) && isConvexOutward(pieces, coincidence) &&
                  std::none_of(vertices.begin(), vertices.end(),
                               [&](const Vec3& p) { return holds(pieces, p, coincidence); });
  }
  for (Blocker& blocker : blockers_) blocker.solid = solid[blocker.body] != 0;
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
  std::nth_element(
      begin, begin + count / 2, begin + count,
      [&](const Blocker& a, const Blocker& b) { return a.middle[axis] < b.middle[axis]; });
  const auto children = std::uint32_t(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  nodes_[node].count = 0;
  buildNode(children, first, count / 2);
  buildNode(children + 1, first + count / 2, count - count / 2);
}

std::vector<const Blocker*> BlockerSet::inside(const Shaft& shaft) const {
  std::vector<const Blocker*> found;
  if (nodes_.empty()) return found;
  std::vector<std::uint32_t> open = {0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (!shaft.mayBlock(node.low, node.high)) continue;
    if (node.count == 0) {
      open.push_back(node.first);
      open.push_back(node.first + 1);
      continue;
    }
    for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
      if (shaft.mayBlock(blockers_[k])) found.push_back(&blockers_[k]);
    }
  }
  return found;
}

}  // namespace radiosity::truth
