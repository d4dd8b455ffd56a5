#include "mesh/cells/four_sides.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/geometry/plane_frame.h"

namespace radiosity {

namespace {

const double kSmallestCorner = glm::radians(30.0);
constexpr double kLargestSideRatio = 1.5;

double distanceToLine(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  return glm::length(glm::cross(along, p - a)) / glm::length(along);
}

/// The places in the loop where it turns.
std::vector<std::size_t> turnsOf(const CoarseComplex& complex, std::span<const Index> loop,
                                 double coincidence) {
  std::vector<std::size_t> corners;
  const std::size_t n = loop.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3& before = complex.vertices[loop[(k + n - 1) % n]];
    const Vec3& after = complex.vertices[loop[(k + 1) % n]];
    const Vec3& here = complex.vertices[loop[k]];
    if (distanceToLine(here, before, after) > coincidence ||
        glm::dot(after - here, here - before) < 0) {
      corners.push_back(k);
    }
  }
  return corners;
}

bool goodShape(const std::array<Vec3, 4>& p, const Vec3& normal) {
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec3 in = p[k] - p[(k + 3) % 4];
    const Vec3 out = p[(k + 1) % 4] - p[k];
    const double turn = std::atan2(glm::dot(glm::cross(in, out), normal), glm::dot(in, out));
    const double angle = glm::radians(180.0) - turn;
    if (turn <= 0 || angle < kSmallestCorner || turn < kSmallestCorner) return false;
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const double side = glm::length(p[k + 1] - p[k]);
    const double opposite = glm::length(p[(k + 3) % 4] - p[k + 2]);
    if (std::max(side, opposite) > kLargestSideRatio * std::min(side, opposite)) return false;
  }
  return true;
}

/// Whether the vertices inside two opposite sides (corners a to b and c to d, around the loop)
/// divide them in the same proportions.
bool dividedAlike(const CoarseComplex& complex, std::span<const Index> side,
                  std::span<const Index> opposite, double coincidence) {
  if (side.size() != opposite.size()) return false;
  const Vec3& a = complex.vertices[side.front()];
  const Vec3& b = complex.vertices[opposite.back()];
  const double length = glm::length(complex.vertices[side.back()] - a);
  const double other = glm::length(complex.vertices[opposite.front()] - b);
  for (std::size_t i = 1; i + 1 < side.size(); ++i) {
    const Vec3& p = complex.vertices[side[i]];
    const Vec3& q = complex.vertices[opposite[opposite.size() - 1 - i]];
    const double difference = glm::length(p - a) / length - glm::length(q - b) / other;
    if (std::abs(difference) * length > coincidence) return false;
  }
  return true;
}

}  // namespace

std::optional<FourSides> findFourSides(const CoarseComplex& complex, const CoarsePolygon& polygon,
                                       std::span<const DirectedEdge> edges) {
  const std::vector<Index>& loop = polygon.loops[0];
  const double coincidence = complex.coincidenceOf(polygon);
  const std::vector<std::size_t> corners = turnsOf(complex, loop, coincidence);
  if (corners.size() != 4) return std::nullopt;
  std::array<Vec3, 4> p;
  FourSides sides;
  for (std::size_t k = 0; k < 4; ++k) {
    sides.corners[k] = loop[corners[k]];
    p[k] = complex.vertices[loop[corners[k]]];
  }
  const Vec3 area = vectorArea(4, [&](std::size_t k) { return p[k]; });
  if (!(glm::length(area) > 0) || !goodShape(p, glm::normalize(area))) return std::nullopt;
  const std::size_t n = loop.size();
  std::array<std::vector<Index>, 4> vertices;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t end = corners[(k + 1) % 4];
    for (std::size_t i = corners[k]; i != end; i = (i + 1) % n) {
      // Vertices that are each in line with their neighbours may still form a curve.
      if (distanceToLine(complex.vertices[loop[i]], p[k], p[(k + 1) % 4]) > coincidence) {
        return std::nullopt;
      }
      sides.edges[k].push_back(edges[i]);
      vertices[k].push_back(loop[i]);
    }
    vertices[k].push_back(loop[end]);
  }
  if (!dividedAlike(complex, vertices[0], vertices[2], coincidence) ||
      !dividedAlike(complex, vertices[1], vertices[3], coincidence)) {
    return std::nullopt;
  }
  return sides;
}

}  // namespace radiosity
