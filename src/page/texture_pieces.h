// The parts of a patch's triangles over which texture coordinates and colours of vertices are
// linear.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "mesh/patches/faces_under_patches.h"

namespace radiosity::page {

/// What a corner of a piece has.
struct PieceCorner {
  Vec3 weights{0.0};  ///< of the corners of the whole triangle
  Vec2 uv{0.0};
  Vec3 colour{1.0};
};
using Piece = std::array<PieceCorner, 3>;

/// Cuts triangles of patches along the faces of the scene. Keeps references.
class TexturePieces {
 public:
  TexturePieces(const Scene& scene, const PatchMesh& mesh);

  bool anyVaries() const { return any_; }
  bool anyColours() const { return any_colours_; }
  /// Goes to a patch; whether its material varies.
  bool enter(Index patch);
  /// Calls visit(piece) for the parts of a triangle of the patch: one, with the same corners in the
  /// same order, if texture coordinates and colours are linear over it.
  void cut(const std::array<Vec3, 3>& corners,
           const std::function<void(const Piece&)>& visit) const;

 private:
  const PatchMesh& mesh_;
  VaryingSurfaces varying_;
  FacesUnderPatches faces_;
  bool any_ = false;
  bool any_colours_ = false;
  PlaneFrame frame_;                     // of the patch
  std::vector<FlatTriangle> triangles_;  // under it
};

}  // namespace radiosity::page
