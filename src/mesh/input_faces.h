// The faces of a scene made fit for meshing: recentred, welded, planar, none twice.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/welded_points.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// How a face of the scene goes into the complex. What cannot be had for one is had for the next.
enum class Handling : std::uint8_t {
  merged,   ///< with the coplanar faces around it
  alone,    ///< as a plane of its own, cut where others touch it
  as_it_is  ///< uncut: others may touch or cross it
};

/// A planar polygon on welded points. `loop` starts at its smallest vertex.
struct InputFace {
  std::vector<Index> loop;
  Index surface = kNone;
  Index source = kNone;  ///< face of the scene
  Vec3 normal{0.0};      ///< unit
  double area = 0;       ///< m^2, as the file has it (before welding)
  Handling handling = Handling::merged;
};

struct InputFaces {
  Vec3 origin{0.0};  ///< subtracted from every vertex: centre of the bounding box
  double coincidence = 0;
  WeldedPoints points{1.0};
  std::vector<InputFace> faces;  ///< sorted by loop: independent of the order in the file
  std::vector<InputFace> uncut;  ///< those to be taken as they are, sorted likewise
};

/// Recentres and welds; splits polygons that are not planar; drops faces thinner than coincidence
/// and faces that are there twice. Fills the report's figures and notes on these, and the
/// surfaces' `given`, `degenerate` and (duplicates) `overlapped`. `handling`: by face of the scene.
/// Errors: InputError for a coordinate that is not finite, or a scene without area.
InputFaces cleanFaces(const Scene& scene, const MeshOptions& options,
                      const std::vector<Handling>& handling, MeshReport& report);

}  // namespace radiosity
