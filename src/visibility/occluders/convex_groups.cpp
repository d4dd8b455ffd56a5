#include "visibility/occluders/convex_groups.h"

#include <algorithm>

#include "base/geometry/point_tree.h"
#include "base/union_find.h"
#include "visibility/occluders/clip.h"

namespace radiosity {

ConvexGroups::ConvexGroups(const OccluderPolygons& all, const OccluderEdgeUsers& users,
                           const std::vector<std::uint8_t>& joins)
    : group_(all.polygons.size()),
      level_(all.polygons.size()),
      size_(all.polygons.size(), 0),
      convex_(all.polygons.size(), 0) {
  UnionFind sets(all.polygons.size());
  UnionFind flat(all.polygons.size());
  for (const auto& [edge, along] : users) {
    const auto back = users.find({edge.second, edge.first});
    if (back == users.end() || edge.second < edge.first) continue;
    for (const Index p : along) {
      for (const Index q : back->second) {
        if (joins[p] == 0 || joins[q] == 0) continue;
        const OccluderPolygon& a = all.polygons[p];
        const OccluderPolygon& b = all.polygons[q];
        if (!isBehind(all, a, planeOf(b)) || !isBehind(all, b, planeOf(a))) continue;
        sets.unite(p, q);
        if (isBehind(all, a, {-b.normal, -b.offset})) flat.unite(p, q);
      }
    }
  }
  for (Index p = 0; p < group_.size(); ++p) {
    group_[p] = sets.find(p);
    level_[p] = flat.find(p);
    ++size_[group_[p]];
  }
  testLarge(all);
}

void ConvexGroups::testLarge(const OccluderPolygons& all) {
  std::map<Index, std::vector<Index>> members;
  for (Index p = 0; p < group_.size(); ++p) {
    if (isLarge(p)) members[group_[p]].push_back(p);
  }
  for (const auto& [group, polygons] : members) {
    std::vector<Index> vertices;
    for (const Index p : polygons) {
      const std::vector<Index>& corners = all.polygons[p].corners;
      vertices.insert(vertices.end(), corners.begin(), corners.end());
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vec3> points;
    points.reserve(vertices.size());
    for (const Index v : vertices) points.push_back(all.vertices[v]);
    const PointTree tree(points);
    convex_[group] = std::none_of(polygons.begin(), polygons.end(), [&](Index p) {
      const OccluderPolygon& polygon = all.polygons[p];
      return tree.anyAbove(polygon.normal, polygon.offset + all.coincidence);
    });
  }
}

}  // namespace radiosity
