// The inner loops of the item buffer, behind plain pointers: one set per instruction set, Highway's
// scalar target among them. Every set gives the same bits: the kernels only add, multiply, divide,
// compare and convert, each correctly rounded by IEEE 754, and nothing is contracted to a fused
// multiply-add.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace radiosity {

/// No polygon: the value of a cleared pixel.
inline constexpr std::uint32_t kSky = 0xffffffffu;

/// Rows of the item buffer start at multiples of this many pixels (a cache line of floats), and
/// kernels may read or write, without effect, up to this many elements past the end of a row.
inline constexpr int kRowAlignment = 16;

/// Pixels [begin, end) of row y, covered by one polygon. The inverse depth at pixel x is
/// slope * (x + first_centre) + inverse_depth.
struct Span {
  std::int32_t y;
  std::int32_t begin;
  std::int32_t end;
  float inverse_depth;  ///< at x = -first_centre
};

/// The buffers that take a polygon's spans. Pixel x has its centre at x + first_centre, measured
/// from the middle of the face.
struct FillTarget {
  float* depth;          ///< inverse depth, larger is nearer; -infinity in a cleared pixel
  std::uint32_t* items;  ///< the nearest item so far
  int stride;            ///< pixels from row to row, a multiple of kRowAlignment
  float first_centre;    ///< (1 - resolution) / 2
};

/// The rational map from the pixels of one row to the cells of a grid: column U(x) / W(x), row
/// V(x) / W(x), rounded to the nearest whole number and moved into the grid; each linear, as in
/// U(x) = u_slope * (x + first_centre) + u.
struct RowMap {
  float u_slope, u;
  float v_slope, v;
  float w_slope, w;
  float first_centre;
  float last_column;        ///< columns - 1
  float last_row;           ///< rows - 1
  float columns;            ///< columns * rows is at most 2^24: cell numbers are whole floats
  std::int32_t first_cell;  ///< the number that the grid's first cell goes by
};

/// W(x) is at least this: it vanishes, by rounding, only at the horizon.
inline constexpr float kLeastW = 1e-30F;
/// Adding and subtracting 2^23 rounds a float of [0, 2^22] to the nearest whole number (of two,
/// the even one).
inline constexpr float kRounder = 8388608.0F;

/// A line that crosses the centres of rows [first, end), x = low_x + (y - low_y) * slope.
struct EdgeRows {
  double low_x, low_y, slope;
  std::int32_t first, end;
  std::int32_t columns;
};

struct RasterKernels {
  std::string target;  ///< instruction set, by Highway's name
  /// crossings[y - first]: the first pixel of row y whose centre is not left of the edge, moved
  /// into [0, columns].
  void (*cross)(const EdgeRows& edge, std::int32_t* crossings);
  /// Sets depth to -infinity and items to kSky in `count` pixels, a multiple of kRowAlignment.
  void (*clear)(float* depth, std::uint32_t* items, std::size_t count);
  /// Depth test and write: a pixel takes `item` where its inverse depth is larger than the stored
  /// one. Strictly, so that of equals the first drawn stays.
  void (*fill)(const FillTarget& target, const Span* spans, std::size_t count, float slope,
               std::uint32_t item);
  /// The same for polygons drawn in any order: of equals the lower item stays.
  void (*fillAnyOrder)(const FillTarget& target, const Span* spans, std::size_t count, float slope,
                       std::uint32_t item);
  /// Writes the positions p in [0, count) where values[p] differs from values[p - 1] (0 always),
  /// ascending, then `count`; returns how many runs there are, `count` not counted. `starts` has
  /// room for count + kRowAlignment.
  std::size_t (*findRuns)(const std::uint32_t* values, int count, std::int32_t* starts);
  /// Divides the pixels [begin, end), a non-empty range, into runs of one cell: run k starts at
  /// pixel starts[k] and lies in cell cells[k] = first_cell + row * columns + column; neighbouring
  /// runs differ. Returns how many there are. Coordinates outside the grid are moved to its border:
  /// a pixel is never lost. `starts` and `cells` have room for end - begin + kRowAlignment.
  std::size_t (*locate)(const RowMap& map, int begin, int end, std::int32_t* starts,
                        std::int32_t* cells);
};

/// The best instruction set of this machine; `simd` false: Highway's scalar target, the same bits.
RasterKernels rasterKernels(bool simd);

}  // namespace radiosity
