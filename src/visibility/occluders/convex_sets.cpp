#include "visibility/occluders/convex_sets.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "visibility/occluders/clip.h"
#include "visibility/occluders/hull.h"

namespace radiosity {

std::vector<Index> ConvexSet::polygons() const {
  std::vector<Index> out;
  out.reserve(members.size());
  for (const Member& m : members) out.push_back(m.polygon);
  return out;
}

std::optional<Occluder> ConvexSetGrowth::hullOf(const ConvexSet& set) const {
  std::vector<Index> vertices = set.vertices;
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<Vec3> points;
  points.reserve(vertices.size());
  for (const Index v : vertices) points.push_back(all_.vertices[v]);
  return convexHull(points, set.planes, all_.coincidence);
}

bool ConvexSetGrowth::isOn(const OccluderPolygon& polygon, const Occluder::Plane& plane) const {
  return isBehind(all_, polygon, plane) && isBehind(all_, polygon, {-plane.normal, -plane.offset});
}

/// Adds a polygon, if this way of growth allows it.
void ConvexSetGrowth::join(ConvexSet& set, Index p, Growth way) const {
  if (way == Growth::known) {
    joinKnown(set, p);
  } else if (way == Growth::greedy) {
    add(set, p);
  } else if (faceOf(set, all_.polygons[p]) == kNone) {
    ConvexSet before = set;
    if (add(set, p) && !staysEmpty(set)) set = std::move(before);
  }
}

void ConvexSetGrowth::joinKnown(ConvexSet& set, Index p) const {
  std::vector<Index>& faces = set.faces_of_level[groups_.levelWith(p)];
  const auto face = std::find_if(faces.begin(), faces.end(),
                                 [&](Index k) { return isOn(all_.polygons[p], set.planes[k]); });
  if (face != faces.end()) {
    append(set, p, *face);
  } else {
    faces.push_back(Index(set.planes.size()));
    append(set, p, kNone);
  }
}

/// Adds a polygon if the set stays in convex position.
bool ConvexSetGrowth::add(ConvexSet& set, Index p) const {
  const OccluderPolygon& polygon = all_.polygons[p];
  for (const Index v : set.vertices) {
    const double height = glm::dot(polygon.normal, all_.vertices[v]) - polygon.offset;
    if (height > all_.coincidence) return false;
  }
  for (const Occluder::Plane& plane : set.planes) {
    if (!isBehind(all_, polygon, plane)) return false;
  }
  append(set, p, faceOf(set, polygon));
  return true;
}

/// Appends a polygon. `face`: kNone for a face of its own.
void ConvexSetGrowth::append(ConvexSet& set, Index p, Index face) const {
  const OccluderPolygon& polygon = all_.polygons[p];
  if (face == kNone) {
    face = Index(set.planes.size());
    set.planes.push_back(planeOf(polygon));
  }
  set.vertices.insert(set.vertices.end(), polygon.corners.begin(), polygon.corners.end());
  set.members.push_back({p, face});
}

/// The first face of the set that a polygon lies on, or kNone.
Index ConvexSetGrowth::faceOf(const ConvexSet& set, const OccluderPolygon& polygon) const {
  const auto face =
      std::find_if(set.planes.begin(), set.planes.end(), [&](const Occluder::Plane& plane) {
        return glm::dot(plane.normal, polygon.normal) > 0 && isOn(polygon, plane);
      });
  return face == set.planes.end() ? kNone : Index(face - set.planes.begin());
}

bool ConvexSetGrowth::staysEmpty(const ConvexSet& set) const {
  const std::optional<Occluder> hull = hullOf(set);
  if (!hull || hull->planes.size() < 4) return true;
  std::vector<Index> polygons = set.polygons();
  std::sort(polygons.begin(), polygons.end());
  return isEmpty(all_, *hull, polygons);
}

void ConvexSetGrowth::sortMembers(ConvexSet& set) {
  std::sort(set.members.begin(), set.members.end(),
            [](const auto& a, const auto& b) { return a.polygon < b.polygon; });
}

}  // namespace radiosity
