// Charts: connected faces that one projection flattens without overlap.
#pragma once

#include <span>
#include <vector>

#include "base/geometry/plane_frame.h"
#include "lightmap/face_triangles.h"

namespace radiosity {

struct Chart {
  std::vector<Index> triangles;  ///< ascending
  PlaneFrame frame;              ///< u along the longest border
  Vec2 low{0.0};                 ///< of the box in the frame, metres
  Vec2 size{0.0};                ///< wider than high
  double least_cosine = 1;       ///< of a triangle's normal to the frame's

  /// Metres from the top left of the box: y grows downwards, as in an image.
  Vec2 place(const Vec3& p) const {
    const Vec2 flat = frame.flat(p);
    return {flat.x - low.x, low.y + size.y - flat.y};
  }
};

/// Puts every triangle into one chart. Neighbours share a chart if the edge between them bends less
/// than `crease` degrees and both are within a cone of kChartCone about the chart's first triangle.
std::vector<Chart> makeCharts(std::span<const FaceTriangle> triangles, double crease,
                              const Progress& progress);

/// Degrees. A chart's projection keeps at least the cosine of this of every length.
inline constexpr double kChartCone = 30;

}  // namespace radiosity
