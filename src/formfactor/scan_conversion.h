// From projected loops to spans of pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "formfactor/face_geometry.h"

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
  void addEdge(Point a, Point b);
  void reserveRows(int first, int end);

  int columns_ = 0;
  int rows_ = 0;
  int first_ = 0;  ///< rows in use: [first_, end_)
  int end_ = 0;
  struct Crossing {
    std::int32_t y, x;
  };
  std::vector<std::int32_t> count_;  ///< crossings of each row
  std::vector<std::int32_t> pair_;   ///< 2 a row: the first two crossings
  std::vector<Crossing> further_;    ///< the third and later ones, of all rows
  std::vector<std::int32_t> row_crossings_;
  std::vector<PixelRun> runs_;
};

}  // namespace radiosity
