// A scene as Embree traces it: the planar polygons, triangulated, in a high-quality tree.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity {

/// Edges are watertight: neighbouring polygons share their vertices, and Embree's robust mode lets
/// no ray through between triangles that do.
class EmbreeScene {
 public:
  explicit EmbreeScene(const ViewScene& scene);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene handle() const { return scene_; }
  /// Embree's coordinates, in single precision, are those of the ViewScene less this: the middle
  /// of the scene, so that none is lost far from the origin.
  const Vec3& middle() const { return middle_; }
  glm::vec3 place(const Vec3& vertex) const { return {vertex - middle_}; }
  /// Corners in ViewScene::vertices.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  /// Position in ViewScene::polygons of each triangle.
  const std::vector<std::uint32_t>& polygonOf() const { return polygon_of_; }

 private:
  Vec3 middle_;
  RTCDevice device_;
  RTCScene scene_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> polygon_of_;
};

/// Flushes denormals while it lives, which Embree's documentation asks for.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned old_mode_;
};

}  // namespace radiosity
