// The light of the elements at any point of a surface.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/geometry/surface_index.h"
#include "radiosity/elements.h"
#include "radiosity/lightmap.h"
#include "radiosity/render.h"

namespace radiosity {

/// The patches of each surface and side that have elements. Keeps all by reference.
class LightOnSurfaces {
 public:
  LightOnSurfaces(const PatchMesh& mesh, const SurfaceLight& light, LightmapShows shows);

  /// The light at the nearest point of the patches of this surface and side that face as `normal`
  /// does; if there is none, of patches turned by up to 60 degrees. False, and black, if there is
  /// none either.
  bool at(Index surface, int side, const Vec3& point, const Vec3& normal, Vec3& value) const;
  /// Whether a patch of this surface and side that faces as `normal` does is within `reach`.
  bool isNear(Index surface, int side, const Vec3& point, const Vec3& normal, double reach) const;

 private:
  struct Patches {
    std::vector<std::array<Index, 3>> triangles;
    std::vector<Index> patch;  ///< of each triangle
    SurfaceIndex index;
    Patches(const PatchMesh& mesh, std::vector<std::array<Index, 3>> pieces,
            std::vector<Index> patches)
        : triangles(std::move(pieces)),
          patch(std::move(patches)),
          index(mesh.vertices, triangles) {}
  };
  const Patches* of(Index surface, int side) const;
  Vec3 valueAt(Index patch, const Vec3& point) const;

  const PatchMesh& mesh_;
  const SurfaceLight& light_;
  LightmapShows shows_;
  ElementLookup lookup_;
  std::map<std::pair<Index, int>, Patches> patches_;
};

}  // namespace radiosity
