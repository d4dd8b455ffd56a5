// The same picture by ray tracing: Embree, set up as fast as it goes.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/hemicube/eye_frame.h"
#include "formfactor/rays/embree_scene.h"
#include "formfactor/view_scene.h"

namespace radiosity::bench {

/// Traces one ray through the centre of every pixel of a hemicube, in coherent packets of 16
/// (4 x 4 pixels), against the triangulated polygons of a scene; high-quality BVH, denormals
/// flushed. It notes which polygon each ray hits and does no more: no look-up of patches, no sums.
class EmbreeView {
 public:
  /// `mesh`: whose scene it is.
  EmbreeView(const ViewScene& scene, const PatchMesh& mesh);

  /// Polygon positions in scene.polygons (kNone: nothing hit), face after face, rows ascending.
  /// `resolution`: a multiple of 8.
  const std::vector<std::uint32_t>& trace(const EyeFrame& frame, int resolution);

  std::size_t triangles() const { return scene_.triangles().size(); }

 private:
  void traceFace(const EyeFrame& frame, int face, int resolution, std::uint32_t* out);

  EmbreeScene scene_;
  std::vector<std::uint32_t> seen_;
};

}  // namespace radiosity::bench
