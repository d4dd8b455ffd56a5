// A scene as a path tracer sees it: triangles in Embree, their materials, what shines.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "radiosity/patch_mesh.h"

namespace radiosity::bench {

/// One side of a triangle.
struct TracedSide {
  bool black = true;  ///< nothing leaves it, all that falls on it stays
  Vec3 reflectance{0.0};
  Vec3 emission{0.0};  ///< radiant exitance, W/m^2
  double aim = 0;      ///< the density with which a light sample falls on it, 1/m^2
};

struct TracedTriangle {
  std::array<Vec3, 3> corner;         ///< metres
  std::array<Vec3, 3> corner_normal;  ///< unit; where facets meet smoothly, the mean of theirs
  Vec3 normal{0.0};
  double longest_edge = 0;
  bool smooth = false;             ///< corner normals are not the triangle's own
  std::array<TracedSide, 2> side;  ///< front, back
};

struct TracedHit {
  Index triangle = kNone;  ///< kNone: nothing was hit
  int side = 0;
  Vec3 at{0.0};
  Vec3 normal{0.0};         ///< of the facet, on the side that was hit
  Vec3 smooth_normal{0.0};  ///< between the corners' normals, on that side
};

/// A place on something that shines.
struct LightSample {
  Vec3 at{0.0};
  Vec3 normal{0.0};
  const TracedSide* side = nullptr;
};

/// The facets are the mesh's: of places where two surfaces lie in one plane the mesh keeps one, and
/// it tiles concave outlines. Materials are the patches'. All calls but the constructor may come
/// from several threads.
class TracedScene {
 public:
  /// `crease`: degrees; facets that bend less at an edge meet smoothly. 0: none do.
  TracedScene(const PatchMesh& mesh, const PatchMaterials& materials, double crease);
  ~TracedScene();
  TracedScene(const TracedScene&) = delete;
  TracedScene& operator=(const TracedScene&) = delete;

  /// The first hit, from `start` on. `through_backs`: what is black from there is not hit.
  TracedHit hit(const Vec3& from, const Vec3& direction, double start, bool through_backs) const;
  /// Whether nothing stands between two points; the first `start` metres do not count.
  bool sees(const Vec3& from, const Vec3& to, double start) const;
  /// A place on what shines, by exitance times area. Only where anything().
  LightSample light(double choice, const Vec2& place) const;
  bool anythingShines() const { return !shining_.empty(); }
  /// Those without a surface that no ray finds.
  const std::vector<Light>& lamps() const { return lamps_; }

  const TracedTriangle& triangle(Index t) const { return triangles_[t]; }
  /// Metres by which rays start off a surface.
  double lift() const { return lift_; }
  bool hasSky() const { return !whole_sky_.empty(); }
  /// Radiance where nothing stands; `whole`: with what is among the lamps, too.
  Vec3 sky(const Vec3& toward, bool whole) const {
    std::array<double, 3> sum{};
    (whole ? whole_sky_ : sky_).add(glm::normalize(toward), 1, sum);
    return {sum[0], sum[1], sum[2]};
  }
  /// Metres: longer than the scene.
  double beyond() const { return beyond_; }

 private:
  struct Shining {
    Index triangle;
    int side;
    double end;  ///< of its share of all
  };
  void findLights();
  void build();
  glm::vec3 place(const Vec3& at) const { return glm::vec3(at - middle_); }

  std::vector<TracedTriangle> triangles_;
  std::vector<Shining> shining_;
  Vec3 middle_{0.0};
  Background sky_;
  Background whole_sky_;
  std::vector<Light> lamps_;
  double lift_ = 0;
  double beyond_ = 0;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace radiosity::bench
