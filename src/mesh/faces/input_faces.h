// Cleans the faces of a scene for meshing: recentred, welded, planar, without duplicates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/welded_points.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// The handling of a face of the scene in the complex. If one fails, the next is tried.
enum class Handling : std::uint8_t {
  merged,   ///< with the coplanar faces around it
  alone,    ///< a plane of its own, cut where others touch it
  as_it_is  ///< uncut: others may touch or cross it
};

/// A planar polygon on welded points. `loop` starts at its smallest vertex.
struct InputFace {
  std::vector<Index> loop;
  Index surface = kNone;
  Index source = kNone;    ///< face of the scene
  Vec3 normal{0.0};        ///< unit
  double area = 0;         ///< m^2, in the file (before welding)
  double coincidence = 0;  ///< metres: the least of its corners'
  Handling handling = Handling::merged;
};

struct InputFaces {
  Vec3 origin{0.0};              ///< subtracted from every vertex: centre of the bounding box
  double diagonal = 0;           ///< metres, of the bounding box
  double coincidence = 0;        ///< metres: the largest; a point of a small thing has less
  WeldedPoints points;           ///< their radii are coincidences
  std::vector<InputFace> faces;  ///< sorted by loop: independent of the order in the file
  std::vector<InputFace> uncut;  ///< faces that are taken as they are, sorted likewise
};

/// The least coincidence of some points.
double coincidenceOf(const WeldedPoints& points, std::span<const Index> some);

/// Recentres and welds; splits polygons that are not planar; drops faces thinner than coincidence
/// and duplicate faces. Points closer than MeshOptions::weld of the scene's diagonal coincide, but
/// never farther than a share of the thing that they belong to (1e-4, or `weld` if that is more):
/// faces of one surface that are connected, however they are cut. Fills the report's figures and
/// notes on these, and the surfaces' `given`, `degenerate` and (duplicates) `overlapped`.
/// `handling`: by face of the scene. Errors: InputError for a coordinate that is not finite, a
/// scene without area, or a surface that would lose all of its area.
InputFaces cleanFaces(const Scene& scene, const MeshOptions& options,
                      const std::vector<Handling>& handling, MeshReport& report);

}  // namespace radiosity
