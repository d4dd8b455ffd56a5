// Rays from one point of a surface: what it sees, and whether it sees another point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formfactor/rays/embree_scene.h"
#include "formfactor/rays/ray_target.h"
#include "formfactor/view_scene.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The place where a ray ended.
struct RayEnd {
  static constexpr std::uint32_t kSky = kNone - 1;
  static constexpr std::uint32_t kBlack = kNone - 2;  ///< a back without patches
  static constexpr std::uint32_t kOwn = kNone - 3;    ///< a polygon that it left from: no true hit
  std::uint32_t patch = kSky;
  Index polygon = kNone;  ///< that was hit
  Vec3 at{0.0};           ///< metres; of the sky: the direction, unit
};

/// A point of a surface; `own`: the polygons that it lies on, which no ray from it ends on.
struct RaySource {
  Vec3 position{0.0};
  Vec3 normal{0.0};  ///< unit
  std::span<const Index> own;
};

/// The first 2^k points of some scrambled Sobol sequences, raised from the disc to
/// cosine-distributed directions (Malley's method, as RayCaster) and sorted so that packets of 16
/// leave in nearly one direction. A point takes one of the sets and turns it about its normal.
/// There are the more sets the fewer rays each has: all points share their heights above the
/// surface.
class HemisphereSet {
 public:
  /// `rays`: a power of two, 16 to kMostPoints.
  HemisphereSet(std::size_t rays, std::uint64_t seed);
  std::size_t rays() const { return rays_; }
  /// The set that a place takes, and its turn about the normal, radians.
  struct Turn {
    std::size_t set;
    double angle;
  };
  Turn turnAt(const Vec3& place, std::uint64_t seed) const;
  /// Direction k of a set about the axis z. The directions with isFirst(k) are the first half of
  /// the sequence: a set of its own, as is the rest.
  const glm::vec3& direction(std::size_t set, std::size_t k) const {
    return directions_[set * rays_ + k];
  }
  bool isFirst(std::size_t set, std::size_t k) const { return first_[set * rays_ + k] != 0; }

 private:
  std::size_t rays_;
  std::size_t sets_;
  std::vector<glm::vec3> directions_;
  std::vector<std::uint8_t> first_;
};

/// All calls but the constructor are thread-safe.
class PointRays {
 public:
  /// `mesh` is kept by reference.
  explicit PointRays(const PatchMesh& mesh);

  const ViewScene& scene() const { return scene_; }
  const EmbreeScene& embree() const { return embree_; }

  /// Finds where the rays of set `number` end, turned about the normal by `turn` radians. `ends`
  /// has set.rays() places.
  void look(const RaySource& from, const HemisphereSet& set, std::size_t number, double turn,
            std::span<RayEnd> ends) const;

  /// Finds where rays from a point in space end, the ray k along the unit vector `along[k]`. `ends`
  /// has along.size() places; a back without patches is kBlack, with its place.
  void trace(const Vec3& from, std::span<const Vec3> along, std::span<RayEnd> ends) const;

  /// seen[k]: nothing stands between the point and `to[k]`. Hits on the polygon `there[k]` and on
  /// the source's own polygons do not count.
  void see(const RaySource& from, std::span<const Vec3> to, std::span<const Index> there,
           std::span<std::uint8_t> seen) const;
  /// The same between `from[k]`, points of one plane, and `to[k]`; without `there` these are in the
  /// open.
  void see(std::span<const Vec3> from, const Vec3& normal, std::span<const Index> own,
           std::span<const Vec3> to, std::span<const Index> there,
           std::span<std::uint8_t> seen) const;

 private:
  glm::vec3 lifted(const Vec3& from, const Vec3& normal) const;
  template <class Start>
  void seeFrom(const Start& start, std::span<const Index> own, std::span<const Vec3> to,
               std::span<const Index> there, std::span<std::uint8_t> seen) const;
  RayEnd endOf(const RTCRayHit16& packet, int k, std::span<const Index> own) const;

  ViewScene scene_;
  EmbreeScene embree_;
  RayTargets targets_;
};

}  // namespace radiosity
