#include "lightmap/face_triangles.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>
#include <utility>

#include "base/geometry/plane_frame.h"
#include "mesh/triangulate.h"
#include "mesh/welded_points.h"

namespace radiosity {
namespace {

/// The triangles of a face, as corners of it.
std::vector<std::array<Index, 3>> cut(const Scene& scene, std::span<const Index> face) {
  if (face.size() == 3) return {{0, 1, 2}};
  const Vec3 area = vectorArea(face.size(), [&](std::size_t k) { return scene.vertices[face[k]]; });
  if (!(glm::length(area) > 0)) return {};
  const Vec3 normal = glm::normalize(area);
  const PlaneFrame frame = makeFrame(scene.vertices[face[0]], normal, axisAcross(normal));
  std::vector<Vec2> outline;
  outline.reserve(face.size());
  for (const Index v : face) outline.push_back(frame.flat(scene.vertices[v]));
  return triangulateOutline(outline);
}

/// An edge of a triangle; sorting brings equal edges together.
struct Edge {
  Index low, high;
  Index triangle;
  std::uint8_t number;
  bool forward;  ///< from low to high
  bool operator<(const Edge& other) const {
    return std::tie(low, high, triangle, number) <
           std::tie(other.low, other.high, other.triangle, other.number);
  }
};

}  // namespace

std::vector<FaceTriangle> frontTriangles(const Scene& scene) {
  std::vector<FaceTriangle> triangles;
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    const std::span<const Index> face = scene.face(f);
    if (face.size() < 3) continue;
    for (const std::array<Index, 3>& corner : cut(scene, face)) {
      FaceTriangle t;
      t.face = Index(f);
      t.surface = scene.face_surface[f];
      t.corner = corner;
      for (std::size_t k = 0; k < 3; ++k) t.position[k] = scene.vertices[face[corner[k]]];
      const Vec3 across = glm::cross(t.position[1] - t.position[0], t.position[2] - t.position[0]);
      const double length = glm::length(across);
      if (!(length > 0) || !std::isfinite(length)) continue;
      t.normal = across / length;
      triangles.push_back(t);
    }
  }
  return triangles;
}

std::vector<FaceTriangle> turnedOver(std::span<const FaceTriangle> fronts) {
  std::vector<FaceTriangle> backs(fronts.begin(), fronts.end());
  for (FaceTriangle& t : backs) {
    std::swap(t.corner[1], t.corner[2]);
    std::swap(t.position[1], t.position[2]);
    t.normal = -t.normal;
    t.neighbour.fill(kNone);
  }
  return backs;
}

void findNeighbours(std::vector<FaceTriangle>& triangles, double weld) {
  WeldedPoints points;
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::array<Index, 3> at{};
    for (std::size_t k = 0; k < 3; ++k) at[k] = points.insert(triangles[t].position[k], weld);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index from = at[k];
      const Index to = at[(k + 1) % 3];
      if (from == to) continue;
      edges.push_back(
          {std::min(from, to), std::max(from, to), Index(t), std::uint8_t(k), from < to});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end].low == edges[k].low && edges[end].high == edges[k].high)
      ++end;
    const Edge& a = edges[k];
    if (end - k == 2 && a.forward != edges[k + 1].forward) {
      const Edge& b = edges[k + 1];
      if (triangles[a.triangle].surface == triangles[b.triangle].surface) {
        triangles[a.triangle].neighbour[a.number] = b.triangle;
        triangles[b.triangle].neighbour[b.number] = a.triangle;
      }
    }
    k = end;
  }
}

}  // namespace radiosity
