// A scene as Embree traces it fastest: the planar polygons, triangulated, in a high-quality BVH.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <vector>

#include "formfactor/view_scene.h"

namespace radiosity::bench {

class EmbreeScene {
 public:
  explicit EmbreeScene(const ViewScene& scene);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene handle() const { return scene_; }
  /// Corners in ViewScene::vertices.
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  /// Position in ViewScene::polygons of each triangle.
  const std::vector<std::uint32_t>& polygonOf() const { return polygon_of_; }

 private:
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

}  // namespace radiosity::bench
