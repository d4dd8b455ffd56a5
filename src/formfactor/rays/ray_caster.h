// Cosine-distributed rays from patches, counted by where they end.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "formfactor/rays/embree_scene.h"
#include "formfactor/rays/ray_kernels.h"
#include "formfactor/rays/ray_origins.h"
#include "formfactor/rays/ray_rows.h"
#include "formfactor/rays/ray_target.h"
#include "formfactor/rays/sobol.h"
#include "formfactor/view_scene.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The share of rays from random points of i, in cosine-distributed directions, that ends on j is
/// an unbiased estimate of F_ij, area to area. (Malley's method: points of a disc, raised to the
/// hemisphere. Howell, Menguc & Siegel, "Thermal Radiation Heat Transfer", ch. 7.)
///
/// Points are Owen-scrambled Sobol points: two dimensions place the ray on the patches, two turn
/// it. Rays go out in packets of 16 through Embree, sorted so that a packet leaves in nearly one
/// direction, against the planar polygons; the patch is found from the hit's position by the
/// polygon's grid.
class RayCaster {
 public:
  /// `mesh` is kept by reference.
  explicit RayCaster(const PatchMesh& mesh);

  /// Counts of where rays ended; cast() adds to them. Items: 0 to N - 1 a patch, N + s the black
  /// back of surface s.
  struct Counts {
    std::vector<std::uint32_t> hits;  ///< items() values
    std::vector<std::uint32_t> hit;   ///< the items with any, in the order they were met
    std::uint32_t sky = 0;

    void add(std::uint32_t item, std::uint32_t more) {
      if (more == 0) return;
      if (hits[item] == 0) hit.push_back(item);
      hits[item] += more;
    }
    /// Sets all counts to 0, in a time that goes with the number of items hit.
    void clear(std::size_t items) {
      if (hits.size() != items) hits.assign(items, 0);
      for (const std::uint32_t item : hit) hits[item] = 0;
      hit.clear();
      sky = 0;
    }
  };
  /// Casts rays `first` to `last` of each replicate's sequence of points, scrambled by `seed` and
  /// by the number after it. Thread-safe.
  void cast(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first, std::uint32_t last,
            std::array<Counts, kReplicates>& of_replicate) const;

  /// A place of the mesh in the coordinates of rays.
  glm::vec3 place(const Vec3& at) const { return embree_.place(at * scene_.scale); }
  /// The coordinates of rays are the mesh's times this, less a middle.
  double scale() const { return scene_.scale; }
  const EmbreeScene& embree() const { return embree_; }
  RayOrigins origins(std::size_t patch) const;
  /// False if something may stand nearer to the origins than rays start before them.
  bool canAim(const RayOrigins& origins) const;
  std::size_t items() const { return mesh_.size() + mesh_.surface_names.size(); }
  std::size_t triangles() const { return embree_.triangles().size(); }
  /// Bytes held by this, about.
  std::size_t bytes() const;

 private:
  struct Batch;

  std::uint32_t itemAt(const EmbreeScene::End& end) const {
    return targets_.itemAt(end.triangle, end.side, end.u, end.v);
  }
  template <class Visit>
  void tracePacket(const RayOrigins& origins, Batch& batch, const std::uint16_t* order, int lanes,
                   const Visit& visit) const;

  const PatchMesh& mesh_;
  ViewScene scene_;
  EmbreeScene embree_;
  SobolPoints sobol_;
  RayTargets targets_;
  RayKernels kernels_;
};

}  // namespace radiosity
