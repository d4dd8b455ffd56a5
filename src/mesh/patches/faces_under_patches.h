// The faces of a scene that lie under a patch, and the surfaces on which materials vary.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "base/geometry/box.h"
#include "base/geometry/plane_frame.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

/// Which surfaces have a reflectance or emission that changes from point to point.
struct VaryingSurfaces {
  std::vector<bool> textured;
  std::vector<bool> coloured;  ///< by colours of vertices

  explicit VaryingSurfaces(const Scene& scene);
  bool at(Index surface) const { return textured[surface] || coloured[surface]; }
};

/// A triangle of a face flattened onto a patch's plane, with what its corners carry.
struct FlatTriangle {
  std::array<Vec2, 3> p;
  std::array<Vec2, 3> uv;
  std::array<Vec3, 3> colour;
  std::array<Index, 3> vertex;  ///< of the scene

  Vec2 map(const Vec2& q) const;
  /// Within 0 and 1, which rounding at an edge of the triangle would leave.
  Vec3 colourAt(const Vec2& q) const;
  /// The part of a convex polygon that lies in the triangle.
  std::vector<Vec2> partOf(std::vector<Vec2> polygon) const;
};

/// Finds the faces under front patches whose materials vary. Keeps references to scene and mesh.
class FacesUnderPatches {
 public:
  /// `wanted`: N, the patches asked about; empty: all.
  FacesUnderPatches(const Scene& scene, const PatchMesh& mesh, const VaryingSurfaces& varying,
                    std::span<const std::uint8_t> wanted = {});

  /// Whether patch i is a front with area whose material varies.
  bool varies(std::size_t i) const;
  /// Metres from patch i within which its faces are looked for: rounding or welding may separate
  /// them.
  double reachOf(std::size_t i) const;
  /// The frame of patch i, which FlatTriangle and parts are in.
  PlaneFrame frameOf(std::size_t i) const;
  /// Calls visit(triangle, part, area) for the parts of patch i that lie in triangles of faces,
  /// those of the nearest faces first, until they cover the patch: `part` is a convex polygon in
  /// the patch's frame. Triangles have their colours if `coloured`. Returns the area of all parts.
  double forParts(
      std::size_t i, bool coloured,
      const std::function<void(const FlatTriangle& triangle, const std::vector<Vec2>& part,
                               double area)>& visit) const;

 private:
  struct Candidate;
  Box3 boxOf(std::size_t i) const;
  std::vector<Candidate> nearestFirst(std::size_t i, const PlaneFrame& frame) const;
  std::vector<FlatTriangle> flattened(Index face, bool coloured, const PlaneFrame& frame) const;

  const Scene& scene_;
  const PatchMesh& mesh_;
  const VaryingSurfaces& varying_;
  std::vector<std::vector<Index>> near_;  // by patch, faces of its surface whose boxes meet its own
};

}  // namespace radiosity
