#include "visibility/occluders/hull.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "base/geometry/point_tree.h"

namespace radiosity {
namespace {

/// Least angle of two faces at an edge, in radians. Planes known to the coincidence then cross
/// within 1,000 coincidences of the edge.
constexpr double kKnifeAngle = 1e-3;

struct FlatPoint {
  Vec2 at;
  Index id;
};

/// Andrew's monotone chain (1979): the strict hull, counter-clockwise.
std::vector<FlatPoint> strictHull(std::vector<FlatPoint> points) {
  std::sort(points.begin(), points.end(), [](const FlatPoint& a, const FlatPoint& b) {
    return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y < b.at.y;
  });
  std::vector<FlatPoint> hull;
  const auto run = [&](auto first, auto last, std::size_t base) {
    for (auto it = first; it != last; ++it) {
      while (hull.size() > base + 1 &&
             cross2(hull.back().at - hull[hull.size() - 2].at, it->at - hull.back().at) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*it);
    }
  };
  run(points.begin(), points.end(), 0);
  const std::size_t lower = hull.size() - 1;
  run(points.rbegin() + 1, points.rend(), lower);
  hull.pop_back();
  return hull;
}

/// With fewer points, a loop over all of them finds those near a plane sooner.
constexpr std::size_t kManyPoints = 64;

/// Grows a hull face by face.
class Wrapping {
 public:
  Wrapping(const std::vector<Vec3>& points, double coincidence)
      : points_(points), coincidence_(coincidence) {
    if (points.size() > kManyPoints) tree_ = PointTree(points);
  }

  /// False if the points on the plane span no face.
  bool addFace(const Occluder::Plane& plane) {
    if (plane.normal == Vec3(0.0)) return false;
    const std::vector<Index> loop =
        planarHull(points_, pointsOn(plane), plane.normal, coincidence_);
    if (loop.size() < 3) return false;
    const Index face = Index(planes_.size());
    planes_.push_back(plane);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const std::pair<Index, Index> edge(loop[k], loop[(k + 1) % loop.size()]);
      if (!face_of_.try_emplace(edge, face).second) return false;
      if (open_.erase({edge.second, edge.first}) == 0) open_.insert(edge);
    }
    return true;
  }

  /// Closes all edges that have a face on one side only.
  bool close() {
    while (!open_.empty()) {
      const std::pair<Index, Index> edge = *open_.begin();
      const std::pair<Index, Index> missing(edge.second, edge.first);
      if (planes_.size() > 2 * points_.size() || !addFace(wrap(missing)) ||
          face_of_.count(missing) == 0) {
        return false;
      }
    }
    return true;
  }

  std::optional<Occluder> finish() const {
    Occluder occluder;
    occluder.planes = planes_;
    std::vector<Index> place(points_.size(), kNone);
    const auto corner = [&](Index v) {
      if (place[v] == kNone) {
        place[v] = Index(occluder.corners.size());
        occluder.corners.push_back(points_[v]);
      }
      return place[v];
    };
    for (const auto& [edge, face] : face_of_) {
      if (edge.first > edge.second) continue;
      occluder.edges.push_back(
          {corner(edge.first), corner(edge.second), face, face_of_.at({edge.second, edge.first})});
    }
    // Euler's formula: anything else is no single closed convex surface.
    if (occluder.corners.size() + occluder.planes.size() != occluder.edges.size() + 2) return {};
    if (!holdsCorners(occluder) || hasKnifeEdge(occluder)) return {};
    boundOccluder(occluder);
    return occluder;
  }

 private:
  std::vector<Index> pointsOn(const Occluder::Plane& plane) const {
    if (points_.size() > kManyPoints) return tree_.near(plane.normal, plane.offset, coincidence_);
    std::vector<Index> members;
    for (Index v = 0; v < points_.size(); ++v) {
      if (std::abs(glm::dot(plane.normal, points_[v]) - plane.offset) <= coincidence_) {
        members.push_back(v);
      }
    }
    return members;
  }

  /// True if two faces meet back to back but for the coincidence: the crossing of their planes is
  /// not known, and points off the body may be behind all of its planes.
  static bool hasKnifeEdge(const Occluder& occluder) {
    return std::any_of(
        occluder.edges.begin(), occluder.edges.end(), [&](const Occluder::Edge& edge) {
          const Vec3& left = occluder.planes[edge.left].normal;
          const Vec3& right = occluder.planes[edge.right].normal;
          return glm::dot(left, right) < 0 && glm::length(glm::cross(left, right)) < kKnifeAngle;
        });
  }

  /// True if no corner is in front of a plane.
  bool holdsCorners(const Occluder& occluder) const {
    const std::vector<Vec3>& corners = occluder.corners;
    const bool many = corners.size() > kManyPoints;
    const PointTree tree = many ? PointTree(corners) : PointTree();
    return std::none_of(
        occluder.planes.begin(), occluder.planes.end(), [&](const Occluder::Plane& plane) {
          const double most = plane.offset + coincidence_;
          if (many) return tree.anyAbove(plane.normal, most);
          return std::any_of(corners.begin(), corners.end(),
                             [&](const Vec3& v) { return glm::dot(plane.normal, v) > most; });
        });
  }

  /// The plane through an edge, the solid on its left, that leaves all points below it.
  Occluder::Plane wrap(const std::pair<Index, Index>& edge) const {
    const Vec3& a = points_[edge.first];
    const Vec3 along = points_[edge.second] - a;
    const double length = glm::length(along);
    Vec3 best(0.0);
    for (const Vec3& p : points_) {
      const Vec3 normal = glm::cross(along, p - a);
      if (glm::length(normal) <= coincidence_ * length) continue;
      if (best == Vec3(0.0) || glm::dot(best, p - a) > 0) best = normal;
    }
    if (best == Vec3(0.0)) return {};
    best = glm::normalize(best);
    return {best, glm::dot(best, a)};
  }

  const std::vector<Vec3>& points_;
  double coincidence_;
  std::vector<Occluder::Plane> planes_;
  std::map<std::pair<Index, Index>, Index> face_of_;  ///< of directed edges
  std::set<std::pair<Index, Index>> open_;            ///< of them: no face on the other side
  PointTree tree_;                                    ///< of many points
};

}  // namespace

std::vector<Index> planarHull(std::span<const Vec3> points, std::span<const Index> members,
                              const Vec3& normal, double coincidence) {
  if (members.size() < 3) return {};
  const PlaneFrame frame = makeFrame(points[members[0]], normal, axisAcross(normal));
  std::vector<FlatPoint> flat;
  for (const Index v : members) flat.push_back({frame.flat(points[v]), v});
  std::vector<FlatPoint> hull = strictHull(std::move(flat));
  for (std::size_t k = 0; k < hull.size() && hull.size() >= 3;) {
    const Vec2& a = hull[(k + hull.size() - 1) % hull.size()].at;
    const Vec2& c = hull[(k + 1) % hull.size()].at;
    if (cross2(c - a, a - hull[k].at) <= coincidence * glm::length(c - a)) {
      hull.erase(hull.begin() + std::ptrdiff_t(k));
      k = k > 0 ? k - 1 : 0;
    } else {
      ++k;
    }
  }
  std::vector<Index> loop;
  if (hull.size() >= 3) {
    for (const FlatPoint& p : hull) loop.push_back(p.id);
  }
  return loop;
}

std::optional<Occluder> convexHull(const std::vector<Vec3>& points,
                                   const std::vector<Occluder::Plane>& planes, double coincidence) {
  Wrapping wrapping(points, coincidence);
  for (const Occluder::Plane& plane : planes) {
    if (!wrapping.addFace(plane)) return {};
  }
  if (planes.empty() || !wrapping.close()) return {};
  return wrapping.finish();
}

void boundOccluder(Occluder& occluder) {
  occluder.centre = boxOf(occluder.corners).centre();
  occluder.radius = 0;
  for (const Vec3& v : occluder.corners) {
    occluder.radius = std::max(occluder.radius, glm::distance(v, occluder.centre));
  }
}

/// Sums cones over the faces, from the centre; a face is a fan of triangles over its edges.
double volumeOf(const Occluder& occluder) {
  double volume = 0;
  for (const Occluder::Edge& edge : occluder.edges) {
    const Vec3 from = occluder.corners[edge.from] - occluder.centre;
    const Vec3 to = occluder.corners[edge.to] - occluder.centre;
    const Vec3 twice = glm::cross(from, to);
    const Occluder::Plane& left = occluder.planes[edge.left];
    const Occluder::Plane& right = occluder.planes[edge.right];
    const double to_left = left.offset - glm::dot(left.normal, occluder.centre);
    const double to_right = right.offset - glm::dot(right.normal, occluder.centre);
    volume += glm::dot(twice, left.normal) * to_left - glm::dot(twice, right.normal) * to_right;
  }
  return volume / 6;
}

}  // namespace radiosity
