// Convex occluders made by hand, as OccluderSet builds them from meshes.
#pragma once

#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "visibility/occluders/occluders.h"

namespace radiosity::test {

/// From its corners and its faces, each counter-clockwise seen from outside.
inline Occluder convexSolid(std::vector<Vec3> corners,
                            const std::vector<std::vector<Index>>& faces) {
  Occluder body;
  body.corners = std::move(corners);
  for (const std::vector<Index>& face : faces) {
    const Vec3& a = body.corners[face[0]];
    const Vec3 normal =
        glm::normalize(glm::cross(body.corners[face[1]] - a, body.corners[face[2]] - a));
    body.planes.push_back({normal, glm::dot(normal, a)});
  }
  for (Index f = 0; f < faces.size(); ++f) {
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      const Index from = faces[f][k];
      const Index to = faces[f][(k + 1) % faces[f].size()];
      for (Index g = f + 1; g < faces.size(); ++g) {
        for (std::size_t m = 0; m < faces[g].size(); ++m) {
          if (faces[g][m] != to || faces[g][(m + 1) % faces[g].size()] != from) continue;
          body.edges.push_back({from, to, f, g});
        }
      }
    }
  }
  for (const Vec3& p : body.corners) body.centre += p / double(body.corners.size());
  for (const Vec3& p : body.corners) {
    body.radius = std::max(body.radius, glm::distance(p, body.centre));
  }
  return body;
}

/// origin + [0,1] u + [0,1] v + [0,1] w, u x v along w.
inline Occluder boxOccluder(const Vec3& origin, const Vec3& u, const Vec3& v, const Vec3& w) {
  std::vector<Vec3> corners;
  corners.reserve(8);
  for (int k = 0; k < 8; ++k) {
    corners.push_back(origin + double(k & 1) * u + double(k >> 1 & 1) * v + double(k >> 2) * w);
  }
  return convexSolid(
      std::move(corners),
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

/// A convex planar loop, either way round, as a body with two faces.
inline Occluder flatOccluder(std::vector<Vec3> loop) {
  Occluder body;
  const Vec3 normal = glm::normalize(glm::cross(loop[1] - loop[0], loop[2] - loop[0]));
  const double offset = glm::dot(normal, loop[0]);
  body.planes = {{normal, offset}, {-normal, -offset}};
  for (Index k = 0; k < loop.size(); ++k) {
    body.edges.push_back({k, Index((k + 1) % loop.size()), 0, 1});
    body.centre += loop[k] / double(loop.size());
  }
  for (const Vec3& p : loop) body.radius = std::max(body.radius, glm::distance(p, body.centre));
  body.corners = std::move(loop);
  body.flat = true;
  return body;
}

/// The rectangle origin + [0,1] u + [0,1] v.
inline Occluder flatRectangle(const Vec3& origin, const Vec3& u, const Vec3& v) {
  return flatOccluder({origin, origin + u, origin + u + v, origin + v});
}

}  // namespace radiosity::test
