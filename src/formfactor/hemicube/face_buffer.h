// The item buffer of a whole face, which tells whether it hides a box.
#pragma once

#include <cstdint>
#include <vector>

#include "base/aligned_buffer.h"
#include "formfactor/hemicube/raster_kernels.h"

namespace radiosity {

/// Pixels [x_begin, x_end) of rows [y_begin, y_end).
struct PixelBox {
  int x_begin = 0, x_end = 0, y_begin = 0, y_end = 0;
  bool isEmpty() const { return x_begin >= x_end || y_begin >= y_end; }
};

/// Depths and items of a face, drawn in any order, and the farthest depth of every tile of kTile x
/// kTile pixels: a box behind that depth in all tiles that it may touch cannot be seen (the
/// z-pyramid of Greene, Kass & Miller, "Hierarchical Z-Buffer Visibility", SIGGRAPH 1993, of one
/// level). Depths are inverse distances (hemicube.h). A tile's farthest depth is found when it is
/// asked for: until then the old one stands, which is farther or the same.
class FaceBuffer {
 public:
  FaceBuffer(int columns, int rows);

  void clear(const RasterKernels& kernels);
  /// Draws one polygon's spans, rows ascending; of equal depths the lower item stays.
  void fill(const RasterKernels& kernels, const std::vector<Span>& spans, float slope,
            std::uint32_t item);
  /// Whether every pixel of the box is nearer than `nearest`, an inverse distance.
  bool hides(const PixelBox& box, double nearest);

  const std::uint32_t* row(int y) const {
    return items_.data() + std::size_t(y) * std::size_t(stride_);
  }
  std::size_t bytes() const {
    return (depth_.size() + items_.size()) * 4 + tiles_.size() * sizeof(Tile);
  }

 private:
  static constexpr int kTile = 8;
  struct Tile {
    float farthest;
    bool is_old;  ///< the tile was drawn on since
  };
  float farthestOf(int column, int row) const;
  bool isNearer(const PixelBox& box, double nearest) const;

  int columns_;
  int rows_;
  int stride_;
  int tile_columns_;
  AlignedBuffer<float> depth_;
  AlignedBuffer<std::uint32_t> items_;
  std::vector<Tile> tiles_;
};

}  // namespace radiosity
