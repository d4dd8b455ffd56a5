// From projected loops to spans of pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/hemicube/raster_kernels.h"

namespace radiosity {

/// Pixels [begin, end) of row y.
struct PixelRun {
  std::int32_t y, begin, end;
};

/// Even-odd scan conversion of the loops of one polygon: concave ones and holes need no
/// triangulation. Pixel (x, y) is inside if its centre (x + 1/2, y + 1/2) is; an edge owns the
/// centres exactly on it if the inside is to its right, and the centres at its lower end's height
/// but not at its upper end's. Edges are evaluated from their lower end (of equals the left one):
/// neighbours that share an edge agree to the bit on who has which pixel.
class ScanConversion {
 public:
  explicit ScanConversion(const RasterKernels& kernels) : cross_(kernels.cross) {}

  /// `columns`, `rows`: of the face, in pixels.
  void begin(int columns, int rows);
  /// Pixel coordinates; closed by its first point. Points a little outside the face are fine.
  struct Point {
    double x, y;
  };
  void addLoop(const std::vector<Point>& loop);
  /// The polygon's pixels, rows ascending, non-empty runs only. Valid until the next begin().
  const std::vector<PixelRun>& finish();

 private:
  /// An edge from its lower to its upper end, crossing the centres of rows [first, end).
  struct Edge {
    Point low, high;
    int first, end;
    bool upward;  ///< as its loop runs
  };
  bool isMonotone() const;
  void crossEdge(const Edge& edge, std::int32_t* crossings) const;
  void finishMonotone();
  void finishAny();
  void addRun(int y, int begin, int end) {
    if (begin < end) runs_.push_back({y, begin, end});
  }

  decltype(RasterKernels::cross) cross_;
  int columns_ = 0;
  int rows_ = 0;
  int loops_ = 0;
  std::vector<Edge> edges_;
  std::vector<std::int32_t> up_;         ///< by row, of a monotone loop: where it runs upwards
  std::vector<std::int32_t> down_;       ///< and downwards
  std::vector<std::int32_t> row_end_;    ///< of any polygon: where each row's crossings end
  std::vector<std::int32_t> crossings_;  ///< row after row
  std::vector<PixelRun> runs_;
};

}  // namespace radiosity
