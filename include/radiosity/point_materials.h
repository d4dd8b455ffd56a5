// Materials at points, where textures or colours of vertices change them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "radiosity/base.h"
#include "radiosity/patch_mesh.h"
#include "radiosity/scene.h"

namespace [[gnu::visibility("default")]] radiosity {

/// Reflectance and emission at the points of patches. Their means over a patch are those of
/// patchMaterials(), but for neighbouring texels, which are blurred into each other.
class PointMaterials {
 public:
  struct Values {
    Vec3 reflectance{0.0};      ///< 0 to 1
    Vec3 emission_factor{1.0};  ///< multiplies the patch's emission
  };

  /// `mesh`: of `scene`, which must outlive this; `materials`: patchMaterials(). `wanted`: N, the
  /// patches asked about; empty: all.
  PointMaterials(const Scene& scene, const PatchMesh& mesh, const PatchMaterials& materials,
                 std::span<const std::uint8_t> wanted = {});
  ~PointMaterials();
  PointMaterials(const PointMaterials&) = delete;
  PointMaterials& operator=(const PointMaterials&) = delete;

  /// Whether the material varies over the patch, so that at() knows it.
  bool varies(std::size_t patch) const;
  /// Precondition: varies(patch). `spacing`: metres between the points asked about; details of a
  /// texture that are finer are averaged.
  Values at(std::size_t patch, const Vec3& point, double spacing) const;

 private:
  struct Data;
  std::unique_ptr<const Data> data_;
};

/// The same; null if no material of the scene varies within a surface.
std::shared_ptr<const PointMaterials> pointMaterials(const Scene& scene, const PatchMesh& mesh,
                                                     const PatchMaterials& materials,
                                                     std::span<const std::uint8_t> wanted = {});

}  // namespace radiosity
