// The faces of a scene made fit for meshing: recentred, welded, planar, none twice.
#pragma once

#include <vector>

#include "mesh/welded_points.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// A planar polygon on welded points. `loop` starts at its smallest vertex.
struct InputFace {
  std::vector<Index> loop;
  Index surface = kNone;
  Index source = kNone;  ///< face of the scene
  Vec3 normal{0.0};      ///< unit
  double area = 0;       ///< m^2, as the file has it (before welding)
};

struct InputFaces {
  Vec3 origin{0.0};  ///< subtracted from every vertex: centre of the bounding box
  double coincidence = 0;
  WeldedPoints points{1.0};
  std::vector<InputFace> faces;  ///< sorted by loop: independent of the order in the file
};

/// Recentres and welds; splits polygons that are not planar; drops faces thinner than coincidence
/// and faces that are there twice. Fills the report's figures and notes on these, and the
/// surfaces' `given`, `degenerate` and (duplicates) `overlapped`.
/// Errors: InputError for a coordinate that is not finite, or a scene without area.
InputFaces cleanFaces(const Scene& scene, const MeshOptions& options, MeshReport& report);

}  // namespace radiosity
