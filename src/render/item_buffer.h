// A z-buffer over tiles: the triangle that each sample of a picture sees.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "radiosity/patch_mesh.h"
#include "render/view.h"

namespace radiosity {

/// Samples of a pixel: S x S cells, one sample a cell, shifted within its cell so that all S^2
/// samples differ in x and in y (the canonical arrangement of Chiu, Shirley & Wang, "Multi-jittered
/// sampling", Graphics Gems IV, 1994). An edge along a pixel row then has S^2 grey levels, not S.
/// S = 1 is the pixel centre.
inline Vec2 sampleOffset(int sample, int samples) {
  const int i = sample % samples;
  const int j = sample / samples;
  return {(i + (j + 0.5) / samples) / samples, (j + (i + 0.5) / samples) / samples};
}

/// The samples of one tile, each with its nearest piece.
struct TileItems {
  int x = 0;  ///< first pixel
  int y = 0;
  int width = 0;
  int height = 0;
  int samples = 1;                    ///< S; S^2 samples a pixel
  std::vector<Index> piece;           ///< into PatchMesh::pieces, or kNone
  std::vector<double> inverse_depth;  ///< 1 / z, 0 where nothing is hit

  /// The samples of one index are stored together along x, since neighbours mostly see the same
  /// piece.
  std::size_t at(int px, int py, int sample) const {
    return (std::size_t(py - y) * (samples * samples) + sample) * width + (px - x);
  }
};

/// Visibility of a mesh from an eye. Triangles are rasterised in homogeneous coordinates (Olano &
/// Greer, "Triangle scan conversion using 2D homogeneous coordinates", Graphics Hardware 1997): the
/// edge function of a, b at the ray d is det(a, b, d). No vertex is divided by its depth, so there
/// is no near plane, and triangles that reach behind the eye need no special case.
///
/// Conventions. A sample exactly on an edge belongs to both sides; edge functions of a shared edge
/// are each other's negative to the bit, so no sample falls between two pieces that share their
/// vertices. Of equal depths the front wins, then the surface that is first by name, the lower
/// index in it, and the front side: the order of the patches in the mesh does not matter.
class ItemBuffer {
 public:
  ItemBuffer(const PatchMesh& mesh, const View& view, int samples, bool show_backs);

  const View& view() const { return view_; }
  int samples() const { return samples_; }  ///< S
  int tileCount() const { return tiles_x_ * tiles_y_; }
  /// Resolves one tile. Different threads may resolve different tiles at once. `items` is scratch
  /// memory and may have been used for another tile.
  void resolve(int tile, TileItems& items) const;

  Index patchOf(Index piece) const { return patch_of_piece_[piece]; }
  /// -det(from, to, d) over pixels, d the ray through (x, y): c.x * x + c.y * y + c.z. Positive
  /// inside an outline seen from the front: its normal n points to the eye, so its corners have
  /// n . p < 0, and pixel space (y down, z away) is as right-handed as the world.
  /// edgeFunction(b, a) is the negative of edgeFunction(a, b) to the bit.
  Vec3 edgeFunction(Index from, Index to) const { return glm::cross(pixels_[to], pixels_[from]); }
  /// True if the eye sees the piece's back.
  bool seenFromBehind(Index piece) const { return facing_[piece] < 0; }

 private:
  struct Bounds {
    int x0, y0, x1, y1;  ///< pixels, half-open; empty where x0 >= x1
  };
  struct Triangle;

  void transform();
  Bounds boundsOf(const std::array<Index, 3>& piece) const;
  Bounds boundsInFront(std::span<const Vec3> corners) const;
  void classify(Index piece, bool show_backs);
  void bin();
  Triangle setUp(Index piece) const;
  void rasterise(Index piece, TileItems& items) const;
  bool goesFirst(Index piece, Index other) const;

  const PatchMesh& mesh_;
  View view_;
  int samples_;
  int tiles_x_;
  int tiles_y_;
  std::vector<Vec3> camera_;  ///< vertices in camera space
  std::vector<Vec3> pixels_;  ///< vertices in pixel space
  std::vector<Index> patch_of_piece_;
  std::vector<std::int8_t> facing_;  ///< 1 front, -1 back, 0: not drawn
  std::vector<Bounds> bounds_;
  std::vector<Index> surface_rank_;  ///< of each surface, by name
  std::vector<std::size_t> tile_begin_;
  std::vector<Index> tile_pieces_;  ///< pieces that may be seen in each tile
};

}  // namespace radiosity
