#include "scene/checks/overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "base/geometry/box_tree.h"
#include "base/geometry/clip.h"
#include "base/geometry/plane_frame.h"

namespace radiosity {

namespace {

Box3 boxOf(const WeldedFaces& faces, std::size_t f) {
  Box3 box;
  for (const Index corner : faces.face(f)) box.add(faces.points[corner]);
  return box.grown(0.5 * faces.tolerance);
}

using Triangle = std::array<Vec2, 3>;

double signedArea(const Triangle& t) { return 0.5 * cross2(t[1] - t[0], t[2] - t[0]); }

/// A convex polygon of few corners, on the stack.
class SmallPolygon {
 public:
  void add(const Vec2& p) {
    if (count_ < corners_.size()) corners_[count_++] = p;
  }
  bool empty() const { return count_ == 0; }
  std::size_t size() const { return count_; }
  const Vec2& operator[](std::size_t k) const { return corners_[k]; }
  double area() const { return polygonArea({corners_.data(), count_}); }

 private:
  std::array<Vec2, 12> corners_;  // a triangle clipped by three half-planes has 6, but for rounding
  std::size_t count_ = 0;
};

bool apart(const Triangle& a, const Triangle& b) {
  for (int k = 0; k < 2; ++k) {
    const auto [low_a, high_a] = std::minmax({a[0][k], a[1][k], a[2][k]});
    const auto [low_b, high_b] = std::minmax({b[0][k], b[1][k], b[2][k]});
    if (high_a <= low_b || high_b <= low_a) return true;
  }
  return false;
}

/// The common area of two counter-clockwise triangles: one is clipped at the edges of the other.
double commonArea(const Triangle& subject, const Triangle& clip) {
  if (apart(subject, clip)) return 0;
  SmallPolygon polygon;
  for (const Vec2& p : subject) polygon.add(p);
  for (std::size_t e = 0; e < 3; ++e) {
    const Vec2 from = clip[e];
    const Vec2 along = clip[(e + 1) % 3] - from;
    SmallPolygon kept;
    clipCorners(
        polygon, [&](const Vec2& p) { return cross2(along, p - from); },
        [&](const Vec2& corner) { kept.add(corner); });
    polygon = kept;
  }
  return polygon.area();
}

PlaneFrame frameOf(const WeldedFaces& faces, std::size_t f) {
  const Vec3 normal = glm::normalize(faces.area_vector[f]);
  return makeFrame(faces.points[faces.face(f)[0]], normal, axisAcross(normal));
}

/// The common area of two polygons of one plane, which may be concave: the indicator of a polygon
/// is the signed sum of the indicators of its fan's triangles.
double commonArea(const WeldedFaces& faces, std::size_t f, std::size_t g) {
  const PlaneFrame frame = frameOf(faces, f);
  const auto fan = [&](std::size_t face_index) {
    const auto face = faces.face(face_index);
    std::vector<Triangle> triangles;
    for (std::size_t k = 2; k < face.size(); ++k) {
      triangles.push_back({frame.flat(faces.points[face[0]]), frame.flat(faces.points[face[k - 1]]),
                           frame.flat(faces.points[face[k]])});
    }
    return triangles;
  };
  const auto counterClockwise = [](Triangle t) {
    if (signedArea(t) < 0) std::swap(t[1], t[2]);
    return t;
  };
  const std::vector<Triangle> fan_g = fan(g);
  double sum = 0;
  for (const Triangle& a : fan(f)) {
    for (const Triangle& b : fan_g) {
      const double sign = (signedArea(a) < 0) != (signedArea(b) < 0) ? -1 : 1;
      sum += sign * commonArea(counterClockwise(a), counterClockwise(b));
    }
  }
  return std::abs(sum);
}

bool liesInPlaneOf(const WeldedFaces& faces, std::size_t f, std::size_t g) {
  const Vec3 normal = glm::normalize(faces.area_vector[g]);
  const Vec3 origin = faces.points[faces.face(g)[0]];
  return std::all_of(faces.face(f).begin(), faces.face(f).end(), [&](Index corner) {
    return std::abs(glm::dot(faces.points[corner] - origin, normal)) <= faces.tolerance;
  });
}

double perimeter(const WeldedFaces& faces, std::size_t f) {
  const auto face = faces.face(f);
  double sum = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    sum += glm::distance(faces.points[face[k]], faces.points[face[(k + 1) % face.size()]]);
  }
  return sum;
}

bool isDegenerate(const WeldedFaces& faces, std::size_t f) { return faces.degenerate[f] != 0; }

/// The most pairs of faces whose boxes touch, and of triangles of faces in one plane: some seconds
/// of work. Usually there are a few dozen a face; a fan of 20,000 faces around one vertex would
/// take minutes.
constexpr double kMostEffort = 2e8;
/// Limits the overlaps that are kept to two million.
constexpr double kOverlapEffort = 100;

}  // namespace

std::vector<DoubledFace> findDoubledFaces(const WeldedFaces& faces) {
  std::vector<DoubledFace> doubled;
  std::map<std::vector<Index>, std::vector<Index>> faces_of;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (isDegenerate(faces, f)) continue;
    std::vector<Index> corners(faces.face(f).begin(), faces.face(f).end());
    std::sort(corners.begin(), corners.end());
    std::vector<Index>& same = faces_of[std::move(corners)];
    const auto first = std::find_if(same.begin(), same.end(), [&](Index g) {
      return glm::dot(faces.area_vector[g], faces.area_vector[f]) > 0;
    });
    if (first != same.end()) {
      doubled.push_back({*first, Index(f)});
    } else {
      same.push_back(Index(f));
    }
  }
  return doubled;
}

OverlapSearch findOverlaps(const WeldedFaces& faces, const std::vector<std::uint8_t>& skip) {
  std::vector<std::size_t> included;
  std::vector<Box3> boxes;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (isDegenerate(faces, f) || skip[f] != 0) continue;
    included.push_back(f);
    boxes.push_back(boxOf(faces, f));
  }
  const BoxTree tree(boxes);
  OverlapSearch search;
  std::vector<Overlap>& overlaps = search.overlaps;
  double effort = 0;
  for (std::size_t i = 0; i < included.size() && effort <= kMostEffort; ++i) {
    const std::size_t f = included[i];
    tree.query(boxes[i], [&](Index j) {
      if (j <= i) return true;
      if (effort > kMostEffort) return false;
      const std::size_t g = included[j];
      effort += 1;
      if (!liesInPlaneOf(faces, g, f) || !liesInPlaneOf(faces, f, g)) return true;
      effort += double(faces.face(f).size()) * double(faces.face(g).size());
      const double area = commonArea(faces, f, g);
      // Neighbours whose shared edge is off by less than coincidence do not overlap.
      const double strip = faces.tolerance * std::min(perimeter(faces, f), perimeter(faces, g));
      const double smaller =
          std::min(glm::length(faces.area_vector[f]), glm::length(faces.area_vector[g]));
      if (area <= strip || area <= 1e-12 * smaller) return true;  // rounding of the clipping
      const bool alike = glm::dot(faces.area_vector[f], faces.area_vector[g]) > 0;
      overlaps.push_back({Index(f), Index(g), alike, area});
      effort += kOverlapEffort;
      return true;
    });
  }
  search.complete = effort <= kMostEffort;
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  return search;
}

double planeDeviation(const WeldedFaces& faces, std::size_t f) {
  const auto face = faces.face(f);
  const double area = glm::length(faces.area_vector[f]);
  if (face.size() < 4 || area == 0) return 0;
  const auto point = [&](std::size_t k) { return faces.points[face[k % face.size()]]; };
  double largest = 0;
  if (face.size() == 4) {
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 normal = glm::cross(point(k + 1) - point(k), point(k + 2) - point(k));
      const double length = glm::length(normal);
      if (length > 0) {
        largest = std::max(largest, std::abs(glm::dot(point(k + 3) - point(k), normal)) / length);
      }
    }
    return largest;
  }
  double lowest = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    const double height = glm::dot(point(k) - point(0), faces.area_vector[f]) / area;
    lowest = std::min(lowest, height);
    largest = std::max(largest, height);
  }
  return largest - lowest;
}

}  // namespace radiosity
