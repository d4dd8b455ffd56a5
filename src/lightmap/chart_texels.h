// The texels of a chart, each with the point and triangle that it shows.
#pragma once

#include <span>
#include <vector>

#include "lightmap/chart_packing.h"

namespace radiosity {

/// A texel at or near a chart.
struct ChartTexel {
  int x = 0;
  int y = 0;
  Index triangle = 0;   ///< the nearest
  bool inside = false;  ///< its centre is in the chart
  Vec3 position{0.0};   ///< the point of the triangle nearest to the centre
};

/// The place of a chart's point in the map, in texels from the top left.
Vec2 texelPlace(const Chart& chart, const ChartPlace& place, double texels_per_metre,
                const Vec3& p);

/// Appends the texels whose centre is within kLightmapPadding texels of the chart; all are in its
/// place. The time is linear in the texels that the triangles and their padding cover.
void appendTexels(std::span<const FaceTriangle> triangles, const Chart& chart,
                  const ChartPlace& place, double texels_per_metre,
                  std::vector<ChartTexel>& texels);

}  // namespace radiosity
