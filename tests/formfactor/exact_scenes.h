// Meshes and brute-force sight lines for the tests of the exact method's visibility.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"
#include "support/scene_builder.h"
#include "visibility/elements/elements.h"
#include "visibility/occluders/occluders.h"

namespace radiosity::test {

inline Scene dataScene(const std::string& name) {
  return loadScene(RADIOSITY_SOURCE_DIR "/data/" + name + ".obj");
}

inline PatchMesh meshOf(const Scene& scene, std::size_t patches, bool faces_as_patches = false) {
  MeshOptions options;
  options.patches = patches;
  options.faces_as_patches = faces_as_patches;
  Progress progress;
  return meshScene(scene, options, progress).mesh;
}

/// The mesh's patches as the faces of a scene, as another program's mesher would write them: every
/// face with vertices of its own.
inline Scene sceneOfPatches(const PatchMesh& mesh, const Scene& from) {
  Scene scene = from;
  scene.vertices.clear();
  scene.corners.clear();
  scene.face_offset = {0};
  scene.face_surface.clear();
  scene.face_element.clear();
  for (std::size_t i = 0; i < mesh.frontCount(); ++i) {
    for (const Index v : mesh.outline(i)) {
      scene.corners.push_back(Index(scene.vertices.size()));
      scene.vertices.push_back(mesh.vertices[v]);
    }
    scene.face_offset.push_back(scene.corners.size());
    scene.face_surface.push_back(mesh.surface[i]);
    scene.face_element.push_back(i);
  }
  return scene;
}

/// Sight lines by the triangles of all patches: knows nothing of polygons and solids.
class SightLines {
 public:
  SightLines(const PatchMesh& mesh, const ElementSet& elements) {
    for (std::size_t i = 0; i < mesh.frontCount(); ++i) {
      for (std::size_t t = mesh.piece_offset[i]; t < mesh.piece_offset[i + 1]; ++t) {
        std::array<Vec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = (mesh.vertices[mesh.pieces[t][k]] - elements.middle) * elements.scale;
        }
        triangles_.push_back(corners);
      }
    }
  }

  enum class Sight { kFree, kBlocked, kDoubtful };

  /// Doubtful: some triangle is met closer than `margin` to its rim or to an end of the line. An
  /// inner edge between two triangles that makes one doubtful does not matter if the line is
  /// doubtful only there: then it is blocked by the one or the other.
  Sight between(const Vec3& p, const Vec3& q, double margin) const {
    Sight sight = Sight::kFree;
    for (const auto& [a, b, c] : triangles_) {
      const Vec3 normal = glm::cross(b - a, c - a);
      const double length = glm::length(normal);
      const double hp = glm::dot(normal, p - a) / length;
      const double hq = glm::dot(normal, q - a) / length;
      if ((hp > 0) == (hq > 0) && std::abs(hp) > margin && std::abs(hq) > margin) continue;
      if (hp == hq) continue;
      const double t = hp / (hp - hq);
      if (t < -margin || t > 1 + margin) continue;
      const Vec3 x = p + t * (q - p);
      double inside = 1;  // distance from the nearest edge line, positive inside
      const std::array<Vec3, 4> ring{a, b, c, a};
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = ring[k + 1] - ring[k];
        const double distance =
            glm::dot(glm::cross(edge, x - ring[k]), normal) / (length * glm::length(edge));
        inside = std::min(inside, distance);
      }
      if (inside < -margin) continue;
      if (inside > margin && std::min(std::abs(hp), std::abs(hq)) > margin && hp * hq < 0) {
        return Sight::kBlocked;
      }
      sight = Sight::kDoubtful;
    }
    return sight;
  }

 private:
  std::vector<std::array<Vec3, 3>> triangles_;
};

/// A point inside an element, evenly spread.
template <class Random>
Vec3 randomPoint(const ElementSet& elements, std::size_t e, Random& random) {
  const auto& c = elements.corners[e];
  const double first = glm::length(glm::cross(c[1] - c[0], c[2] - c[0]));
  const double second = glm::length(glm::cross(c[2] - c[0], c[3] - c[0]));
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const bool in_first = unit(random) * (first + second) < first;
  double u = unit(random);
  double v = unit(random);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const Vec3& a = in_first ? c[1] : c[2];
  const Vec3& b = in_first ? c[2] : c[3];
  return c[0] + u * (a - c[0]) + v * (b - c[0]);
}

inline bool faceEachOther(const Facet& a, const Vec3& p, const Facet& b, const Vec3& q) {
  return glm::dot(a.normal, q - p) > 0 && glm::dot(b.normal, p - q) > 0;
}

/// The part of a segment inside a body, as a length; of a flat one, 1 where it is crossed.
inline double lengthInside(const Occluder& body, const Vec3& p, const Vec3& q, double margin) {
  double enter = 0;
  double leave = 1;
  for (const Occluder::Plane& plane : body.planes) {
    const double hp = glm::dot(plane.normal, p) - plane.offset + margin;
    const double hq = glm::dot(plane.normal, q) - plane.offset + margin;
    if (body.flat) continue;
    if (hp > 0 && hq > 0) return 0;
    if (hp > 0) enter = std::max(enter, hp / (hp - hq));
    if (hq > 0) leave = std::min(leave, hp / (hp - hq));
  }
  if (!body.flat) return std::max(0.0, leave - enter) * glm::distance(p, q);
  const double hp = glm::dot(body.planes[0].normal, p) - body.planes[0].offset;
  const double hq = glm::dot(body.planes[0].normal, q) - body.planes[0].offset;
  if (hp * hq >= 0 || std::min(std::abs(hp), std::abs(hq)) <= std::abs(margin)) return 0;
  const Vec3 x = p + (q - p) * (hp / (hp - hq));
  for (const Occluder::Edge& edge : body.edges) {
    const Vec3& a = body.corners[edge.from];
    const Vec3 along = glm::normalize(body.corners[edge.to] - a);
    if (glm::dot(glm::cross(along, x - a), body.planes[edge.left].normal) < margin) return 0;
  }
  return 1;
}

/// Whether one of the bodies blocks a line by more than `margin`; a negative one counts lines that
/// pass it so close as blocked.
template <class Bodies>
bool blocks(const Bodies& bodies, const Vec3& p, const Vec3& q, double margin) {
  for (const Occluder& body : bodies) {
    if (lengthInside(body, p, q, margin) > std::abs(margin)) return true;
  }
  return false;
}

/// A room of 4 x 4 x 3 with hard cases: blocks that stand on the floor, on each other and side by
/// side, an L-shaped solid, a two-sided sheet, a wall with a window, a plate of two surfaces.
inline Scene hardRoom() {
  SceneBuilder b;
  const Index room = b.surface("room");
  b.box(room, {0, 0, 0}, {4, 4, 3}, false);
  const Index block = b.surface("block");
  b.box(block, {0.5, 0.5, 0}, {1.3, 1.2, 1.0});  // on the floor
  b.prism(block, SceneBuilder::turnedRectangle({0.9, 0.85}, 0.4, 0.3, 0.5), 1.0, 1.4);  // on it
  const Index books = b.surface("books");
  b.box(books, {2.0, 0.5, 0}, {2.2, 1.0, 0.8});
  b.box(books, {2.2, 0.5, 0}, {2.5, 0.9, 0.6});  // beside the first, lower and less deep
  b.box(books, {2.5, 0.55, 0}, {2.6, 1.1, 0.9});
  const Index corner = b.surface("corner");
  b.prism(corner, {{3.4, 2.6}, {4.0, 2.6}, {4.0, 3.4}, {3.7, 3.4}, {3.7, 2.9}, {3.4, 2.9}}, 0,
          1.2);  // L-shaped, against the wall
  const Index sheet = b.surface("sheet", 0.5, 0.0, true);
  b.face(sheet, {{1.0, 2.0, 1.2}, {1.9, 2.2, 1.0}, {2.0, 2.9, 1.6}, {1.1, 2.7, 1.8}});
  const Index screen = b.surface("screen");  // two frames with a window, back to back
  for (const bool back : {false, true}) {
    for (std::vector<Vec3> f : std::vector<std::vector<Vec3>>{
             {{0.3, 3.2, 0.2}, {0.7, 3.2, 0.2}, {0.7, 3.2, 1.8}, {0.3, 3.2, 1.8}},
             {{1.3, 3.2, 0.2}, {1.9, 3.2, 0.2}, {1.9, 3.2, 1.8}, {1.3, 3.2, 1.8}},
             {{0.7, 3.2, 0.2}, {1.3, 3.2, 0.2}, {1.3, 3.2, 0.6}, {0.7, 3.2, 0.6}},
             {{0.7, 3.2, 1.2}, {1.3, 3.2, 1.2}, {1.3, 3.2, 1.8}, {0.7, 3.2, 1.8}}}) {
      if (back) std::reverse(f.begin(), f.end());
      b.face(screen, f);
    }
  }
  const Index left = b.surface("left", 0.5, 0.0, true);
  const Index right = b.surface("right", 0.5, 0.0, true);
  b.level(left, 2.4, 2.0, 2.8, 2.6, 1.7);
  b.level(right, 2.8, 2.0, 3.2, 2.6, 1.7);
  return b.scene();
}

}  // namespace radiosity::test
