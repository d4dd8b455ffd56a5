// Finds the face of the scene under a point of a planar polygon.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "radiosity/scene.h"

namespace radiosity {

/// Some faces of a scene, flattened onto one plane.
class FaceLocator {
 public:
  /// `frame` is relative to `origin`, a point of the scene near the faces.
  FaceLocator(const Scene& scene, std::span<const Index> faces, const PlaneFrame& frame,
              const Vec3& origin);

  /// A point of a face as a mean of three of its corners (into Scene::corners).
  struct Place {
    Index face = kNone;
    std::array<std::size_t, 3> corners{};
    std::array<double, 3> weights{};
  };

  /// The face under `p` (relative to the origin): of the faces whose outline contains p, the
  /// nearest to the plane through p; if there is none, the face with the nearest outline.
  /// `preferred` wins if it contains p. Needs at least one face.
  Place locate(const Vec3& p, Index preferred = kNone) const;

 private:
  struct Triangle {
    Index face;
    std::array<std::size_t, 3> corners;
    std::array<Vec2, 3> p;
    std::array<double, 3> height;  ///< of the corners above the frame's plane
  };
  std::size_t cell(double x, int axis) const;
  Place place(const Triangle& triangle, const Vec2& q) const;

  PlaneFrame frame_;
  std::vector<Triangle> triangles_;
  Vec2 lower_{0.0};
  Vec2 inverse_cell_{0.0};
  std::array<std::size_t, 2> count_{1, 1};
  std::vector<std::vector<Index>> grid_;
};

}  // namespace radiosity
