#include "scene/checks/welded_faces.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <unordered_map>

#include "base/geometry/plane_frame.h"
#include "base/hash.h"

namespace radiosity {

namespace {

/// Finds an existing point within the tolerance, or adds one. It is a hash of cubes with an edge of
/// four tolerances, so that most searches visit only one cube.
class PointSet {
 public:
  PointSet(double tolerance, std::vector<Vec3>& points) : tolerance_(tolerance), points_(points) {}

  Index find(const Vec3& p) {
    // Without a tolerance only equal coordinates are one place (-0 and 0 are equal).
    const Vec3 place = p + Vec3(0.0);
    const Cell low = cellOf(place - Vec3(tolerance_));
    const Cell high = cellOf(place + Vec3(tolerance_));
    for (double x = low[0]; x <= high[0]; ++x) {
      for (double y = low[1]; y <= high[1]; ++y) {
        for (double z = low[2]; z <= high[2]; ++z) {
          const Index found = findIn({x, y, z}, place);
          if (found != kNone) return found;
        }
      }
    }
    cells_[cellOf(place)].push_back(Index(points_.size()));
    points_.push_back(place);
    return Index(points_.size() - 1);
  }

 private:
  using Cell = std::array<double, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& cell) const {
      Hash hash;
      hash.bytes(cell.data(), sizeof cell);
      return hash.value();
    }
  };

  Cell cellOf(const Vec3& p) const {
    if (tolerance_ == 0) return {p.x, p.y, p.z};
    const double edge = 4 * tolerance_;
    // + 0.0 turns -0 into 0, since cells are compared by their bytes.
    return {std::floor(p.x / edge) + 0.0, std::floor(p.y / edge) + 0.0,
            std::floor(p.z / edge) + 0.0};
  }

  Index findIn(const Cell& cell, const Vec3& p) const {
    const auto found = cells_.find(cell);
    if (found == cells_.end()) return kNone;
    for (const Index candidate : found->second) {
      if (glm::distance(points_[candidate], p) <= tolerance_) return candidate;
    }
    return kNone;
  }

  double tolerance_;
  std::vector<Vec3>& points_;
  std::unordered_map<Cell, std::vector<Index>, CellHash> cells_;
};

/// Twice the area over the longest edge: at least the least width of the polygon.
double width(const WeldedFaces& faces, std::size_t f) {
  const auto face = faces.face(f);
  double longest = 0;
  for (std::size_t k = 0; k < face.size(); ++k) {
    longest = std::max(
        longest, glm::distance(faces.points[face[k]], faces.points[face[(k + 1) % face.size()]]));
  }
  return longest > 0 ? 2 * glm::length(faces.area_vector[f]) / longest : 0;
}

}  // namespace

WeldedFaces weldFaces(const Scene& scene, const Vec3& lower, const Vec3& upper, double weld) {
  WeldedFaces faces;
  faces.centre = 0.5 * (lower + upper);
  faces.tolerance = weld * glm::distance(lower, upper);
  PointSet set(faces.tolerance, faces.points);
  std::vector<Index> welded(scene.vertices.size(), kNone);
  faces.offset.push_back(0);
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    const std::size_t first = faces.corners.size();
    const auto face = scene.face(f);
    for (const Index vertex : face) {
      if (welded[vertex] == kNone) {
        welded[vertex] = set.find(scene.vertices[vertex] - faces.centre);
      }
      const bool repeats = faces.corners.size() > first && faces.corners.back() == welded[vertex];
      if (!repeats) faces.corners.push_back(welded[vertex]);
    }
    while (faces.corners.size() > first + 1 && faces.corners.back() == faces.corners[first]) {
      faces.corners.pop_back();
    }
    faces.offset.push_back(faces.corners.size());
    faces.area_vector.push_back(vectorArea(
        face.size(), [&](std::size_t k) -> const Vec3& { return scene.vertices[face[k]]; }));
    const bool thin = faces.face(f).size() < 3 || width(faces, f) <= faces.tolerance;
    faces.degenerate.push_back(thin ? 1 : 0);
  }
  return faces;
}

}  // namespace radiosity
