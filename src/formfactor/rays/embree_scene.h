// A scene as Embree traces it: the planar polygons, triangulated, in a high-quality tree.
#pragma once

#include <embree3/rtcore.h>

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "formfactor/view_triangles.h"

namespace radiosity {

/// Rays that are traced at once.
constexpr int kRayLanes = 16;
/// Rays start this far in front of their surface, in scenes of size 1: a few roundings of single
/// precision, so that few hit their own polygon and next to none miss a wall that it touches.
constexpr float kRayLift = 2e-7F;

/// Makes a packet of rays without ends that have hit nothing; where they leave and their directions
/// stay as they are.
inline void initPacket(RTCRayHit16& packet) {
  for (int k = 0; k < kRayLanes; ++k) {
    packet.ray.tnear[k] = 0;
    packet.ray.tfar[k] = std::numeric_limits<float>::infinity();
    packet.ray.time[k] = 0;
    packet.ray.mask[k] = 0xffffffffu;
    packet.ray.flags[k] = 0;
    packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
}

/// Puts a ray into lane k of a packet; `along`: a unit vector.
inline void setRay(RTCRayHit16& packet, int k, const glm::vec3& from, const glm::vec3& along) {
  packet.ray.org_x[k] = from.x;
  packet.ray.org_y[k] = from.y;
  packet.ray.org_z[k] = from.z;
  packet.ray.dir_x[k] = along.x;
  packet.ray.dir_y[k] = along.y;
  packet.ray.dir_z[k] = along.z;
}

/// Whether rays of a packet meet much the same parts of the tree.
enum class Coherence { coherent, incoherent };

/// Edges are watertight: neighbouring polygons share their vertices, and Embree's robust mode lets
/// no ray through between triangles that do.
class EmbreeScene {
 public:
  /// `mesh`: the one that `scene` was made from. A polygon whose outlines cross is taken as the
  /// triangles that tile its patches.
  EmbreeScene(const ViewScene& scene, const PatchMesh& mesh);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene handle() const { return scene_; }
  /// The middle of the scene. Embree's coordinates, in single precision, are those of the ViewScene
  /// less this, so that no digits are lost far from the origin.
  const Vec3& middle() const { return middle_; }
  glm::vec3 place(const Vec3& vertex) const { return {vertex - middle_}; }
  /// Traces the first `lanes` rays of a packet: together if they are coherent, else one by one.
  void trace(RTCRayHit16& packet, int lanes, Coherence coherence = Coherence::coherent) const;
  /// Where a ray ends: on a side of a triangle (0 the front, 1 the back), at Embree's u, v.
  struct End {
    std::uint32_t triangle;
    int side;
    float u;
    float v;
  };
  /// Whether a triangle, or one of a polygon of the mesh, has others so near (near_triangles.h)
  /// that what rays meet there is settled in double precision.
  bool isNear(std::uint32_t triangle) const { return !near_.empty() && near_[triangle] != 0; }
  bool isNearPolygon(Index polygon) const { return !near_.empty() && plane_of_[polygon].near; }
  /// What a ray meets first where lane k of a packet has a hit: if a front and a back coincide, the
  /// two sides of a plate without thickness, it meets the front. `own`: the polygon that the ray
  /// leaves, or kNone.
  End endAt(const RTCRayHit16& packet, int k, Index own) const;
  /// What a ray meets within some kRayLift of `own`, an isNearPolygon() that it leaves: `from` has
  /// left it by kRayLift, perhaps beyond what it meets. Nothing if there is none.
  std::optional<End> endBefore(const glm::vec3& from, const glm::vec3& along, Index own) const;
  /// Where a ray ends if `own`, the polygon of the mesh that it leaves, is not there.
  std::optional<End> endBeyond(const glm::vec3& from, const glm::vec3& along, Index own) const;
  /// The vertices of the ViewScene and of such tiles, in its coordinates.
  const std::vector<Vec3>& vertices() const { return all_.vertices; }
  /// Corners in vertices().
  const std::vector<std::array<std::uint32_t, 3>>& triangles() const { return all_.triangles; }
  /// Position in ViewScene::polygons of each triangle.
  const std::vector<std::uint32_t>& polygonOf() const { return all_.polygon_of; }

 private:
  Vec3 middle_;
  RTCDevice device_;
  RTCScene scene_;
  ViewTriangles all_;
  std::vector<Index> source_of_;  ///< the polygon of the mesh of each triangle
  struct Plane {
    Vec3 normal;
    Vec3 origin;  ///< less middle()
    bool near;
  };
  double coincidence_;              ///< of the ViewScene
  std::vector<std::uint8_t> near_;  ///< by triangle; empty: none is
  std::vector<Plane> plane_of_;     ///< by polygon of the mesh, if any is near

  class Settling;
  End settled(const glm::vec3& from, const glm::vec3& along, float at, const glm::vec3& normal,
              const End& found, Index own) const;
  void findNear(const ViewScene& scene, const PatchMesh& mesh);
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
