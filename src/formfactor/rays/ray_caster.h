// Cosine-distributed rays from the patches of an unknown, counted by where they end.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
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

/// The items that rays count for.
enum class RayItems { unknowns, patches };

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
  explicit RayCaster(const PatchMesh& mesh, RayItems items = RayItems::unknowns);

  /// Counts of where rays ended; cast() adds to them. Items: 0 to K-1 an unknown
  /// (PatchMesh::unknowns()), or a patch, K + s the black back of surface s.
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

  /// Visits `rays` rays of every replicate in a fixed order: where each leaves, the normal there,
  /// and the item it ends on, items() for the sky. Thread-safe.
  using EndVisitor =
      std::function<void(const glm::vec3& from, const glm::vec3& normal, std::uint32_t item)>;
  void visitEnds(const RayOrigins& origins, std::uint64_t seed, std::uint32_t rays,
                 const EndVisitor& visit) const;
  /// The same, with the items that the rays end on kept in `ends`, in the order of their tracing.
  /// Empty `ends` are filled; with those of an earlier call for the same rays, none is traced
  /// again.
  using Ends = std::vector<std::uint32_t>;
  void visitEnds(const RayOrigins& origins, std::uint64_t seed, std::uint32_t rays, Ends& ends,
                 const EndVisitor& visit) const;

  /// A place of the mesh in the coordinates of rays.
  glm::vec3 place(const Vec3& at) const { return embree_.place(at * scene_.scale); }
  /// The coordinates of rays are the mesh's times this, less a middle.
  double scale() const { return scene_.scale; }
  const EmbreeScene& embree() const { return embree_; }
  RayOrigins origins(std::size_t unknown) const;
  /// False if something may stand nearer to the origins than rays start before them.
  bool canAim(const RayOrigins& origins) const;
  /// K: the number of items that are fronts.
  std::size_t fronts() const {
    return items_ == RayItems::unknowns ? mesh_.unknowns() : mesh_.size();
  }
  std::size_t items() const { return fronts() + mesh_.surface_names.size(); }
  std::size_t triangles() const { return embree_.triangles().size(); }
  /// Bytes held by this, about.
  std::size_t bytes() const;

 private:
  struct Batch;

  std::uint32_t frontOf(std::size_t patch) const {
    return std::uint32_t(items_ == RayItems::unknowns ? mesh_.unknownOf(patch) : patch);
  }
  std::uint32_t rayItem(std::uint32_t item) const;
  std::uint32_t itemAt(const EmbreeScene::End& end) const {
    return targets_.itemAt(end.triangle, end.side, end.u, end.v);
  }
  template <class Packet>
  void forPackets(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first,
                  std::uint32_t last, const Packet& packet) const;
  template <class Visit>
  void trace(const RayOrigins& origins, std::uint64_t seed, std::uint32_t first, std::uint32_t last,
             const Visit& visit) const;
  void visitEnd(const RayOrigins& origins, const Batch& batch, std::size_t ray, std::uint32_t item,
                const EndVisitor& visit) const;
  template <class Visit>
  void tracePacket(const RayOrigins& origins, Batch& batch, const std::uint16_t* order, int lanes,
                   const Visit& visit) const;

  const PatchMesh& mesh_;
  std::vector<Index> ordered_;  ///< as PatchClusters::patches, each cluster in originOrder()
  RayItems items_;
  ViewScene scene_;
  EmbreeScene embree_;
  SobolPoints sobol_;
  RayTargets targets_;
  RayKernels kernels_;
};

}  // namespace radiosity
