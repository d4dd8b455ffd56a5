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
  /// `mesh`: whose ViewScene that is. A polygon whose outlines cross is taken as the triangles that
  /// tile its patches.
  EmbreeScene(const ViewScene& scene, const PatchMesh& mesh);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene handle() const { return scene_; }
  /// Embree's coordinates, in single precision, are those of the ViewScene less this: the middle
  /// of the scene, so that none is lost far from the origin.
  const Vec3& middle() const { return middle_; }
  glm::vec3 place(const Vec3& vertex) const { return {vertex - middle_}; }
  /// The front that covers the back which lane k of a packet has hit: of a plate without thickness,
  /// two polygons back to back, the front covers the back, but in depth they are a tie. Its geomID
  /// is RTC_INVALID_GEOMETRY_ID where there is none.
  RTCHit frontAt(const RTCRayHit16& packet, int k) const;
  /// In the coordinates of the ViewScene: its vertices, and those of such tiles.
  const std::vector<Vec3>& vertices() const { return vertices_; }
  /// Corners in vertices().
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return triangles_; }
  /// Position in ViewScene::polygons of each triangle.
  const std::vector<std::uint32_t>& polygonOf() const { return polygon_of_; }

 private:
  using Triangle = std::array<std::uint32_t, 3>;
  void addTiles(const ViewScene& scene, const PatchMesh& mesh,
                const std::vector<Index>& without_triangles);

  Vec3 middle_;
  RTCDevice device_;
  RTCScene scene_;
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
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
