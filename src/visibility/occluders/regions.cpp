#include "visibility/occluders/regions.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/geometry/plane_frame.h"
#include "base/geometry/solid_angle.h"
#include "base/union_find.h"

namespace radiosity {
namespace {

/// A point inside a polygon; nothing if it cannot be triangulated.
std::optional<Vec3> innerPoint(const OccluderPolygons& all, const OccluderPolygon& polygon) {
  double largest = 0;
  std::optional<Vec3> point;
  for (const auto& t : all.trianglesOf(polygon)) {
    const Vec3& a = all.vertices[t[0]];
    const Vec3& b = all.vertices[t[1]];
    const Vec3& c = all.vertices[t[2]];
    const double area = glm::length(glm::cross(b - a, c - a));
    if (area > largest) {
      largest = area;
      point = (a + b + c) / 3.0;
    }
  }
  return point;
}

/// Signed solid angle of a polygon seen from a point off its plane.
double solidAngle(const OccluderPolygons& all, const OccluderPolygon& polygon, const Vec3& eye) {
  double angle = 0;
  for (const std::vector<Index>& loop : polygon.loops) {
    const auto corner = [&](std::size_t k) { return all.vertices[loop[k]]; };
    angle += loopSolidAngle(loop.size(), corner, eye);
  }
  return angle;
}

}  // namespace

OccluderRegions::OccluderRegions(const OccluderPolygons& all, const OccluderEdgeUsers& users)
    : all_(all), component_(all.polygons.size()), side_class_(all.polygons.size()) {
  const std::size_t count = all.polygons.size();
  UnionFind joined(count);
  UnionFind same_front(count);
  std::vector<std::uint8_t> open(count, 0);
  for (const auto& [edge, along] : users) {
    for (const Index p : along) joined.unite(p, along.front());
    const auto back = users.find({edge.second, edge.first});
    const std::size_t against = back == users.end() ? 0 : back->second.size();
    if (against > 0) joined.unite(along.front(), back->second.front());
    if (against != along.size()) open[along.front()] = 1;
    if (against == 1 && along.size() == 1) same_front.unite(along[0], back->second[0]);
  }
  std::vector<Index> place(count, kNone);
  for (Index p = 0; p < count; ++p) {
    const Index root = joined.find(p);
    if (place[root] == kNone) {
      place[root] = Index(members_.size());
      members_.emplace_back();
      closed_.push_back(1);
    }
    component_[p] = place[root];
    side_class_[p] = same_front.find(p);
    members_[component_[p]].push_back(p);
    if (open[p] || !all.polygons[p].one_sided) closed_[component_[p]] = 0;
  }
  looked_into_.assign(members_.size(), 0);
  occupied_.resize(members_.size());
  std::vector<Box3> firsts;
  for (const std::vector<Index>& members : members_) {
    firsts.push_back(all.polygons[members.front()].box);
    Box3& bound = bounds_.emplace_back();
    for (const Index p : members) {
      bound.add(all.polygons[p].box.low);
      bound.add(all.polygons[p].box.high);
    }
  }
  first_members_ = BoxTree(firsts);
}

std::optional<int> OccluderRegions::doubledWinding(Index component, Index polygon) {
  solid_angles_ += members_[component].size();
  if (solid_angles_ > kMostSolidAngles) return {};
  const std::optional<Vec3> eye = innerPoint(all_, all_.polygons[polygon]);
  if (!eye) return {};
  double angle = 0;
  for (const Index p : members_[component]) {
    if (p != polygon) angle += solidAngle(all_, all_.polygons[p], *eye);
  }
  const double doubled = angle / (2 * std::numbers::pi);
  // A whole number but for rounding, unless the point lies on a polygon.
  if (std::abs(doubled - std::round(doubled)) > 0.01) return {};
  return int(std::round(doubled));
}

void OccluderRegions::lookInto(Index component) {
  looked_into_[component] = 1;
  if (!lookFromMembers(component) || !lookFromOthers(component)) closed_[component] = 0;
}

/// Finds the windings in front of the members; false if one cannot be told.
bool OccluderRegions::lookFromMembers(Index component) {
  for (const Index p : members_[component]) {
    if (front_winding_.count(side_class_[p]) != 0) continue;
    const std::optional<int> doubled = doubledWinding(component, p);
    // On a polygon the surface winds half a time more than in front of it.
    if (!doubled || *doubled % 2 == 0) return false;
    front_winding_[side_class_[p]] = (*doubled - 1) / 2;
    occupied_[component].insert((*doubled - 1) / 2);
  }
  return true;
}

bool OccluderRegions::lookFromOthers(Index component) {
  std::size_t near = 0;
  bool known = true;
  first_members_.query(bounds_[component].grown(all_.coincidence), [&](Index other) {
    ++near;
    if (other == component) return true;
    const std::optional<int> doubled = doubledWinding(component, members_[other].front());
    known = doubled && *doubled % 2 == 0;
    if (known) occupied_[component].insert(*doubled / 2);
    return known;
  });
  // The surface does not wind about points outside its box.
  if (near < members_.size()) occupied_[component].insert(0);
  return known;
}

bool OccluderRegions::isBehindOpaque(Index polygon) {
  const Index component = component_[polygon];
  if (!closed_[component]) return false;
  if (!looked_into_[component]) lookInto(component);
  if (!closed_[component]) return false;
  return occupied_[component].count(front_winding_.at(side_class_[polygon]) + 1) == 0;
}

}  // namespace radiosity
