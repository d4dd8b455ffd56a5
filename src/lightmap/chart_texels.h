// The texels of a chart: which point of which triangle each of them shows.
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
  Vec3 position{0.0};   ///< the point of the triangle that is nearest to the centre
};

/// Where a point of a chart lies in the map, in texels from its top left.
Vec2 texelPlace(const Chart& chart, const ChartPlace& place, double texels_per_metre,
                const Vec3& p);

/// Appends the texels whose centre is kLightmapPadding texels from the chart or nearer; all are in
/// its place. Linear in the texels that the triangles' surroundings cover.
void appendTexels(std::span<const FaceTriangle> triangles, const Chart& chart,
                  const ChartPlace& place, double texels_per_metre,
                  std::vector<ChartTexel>& texels);

}  // namespace radiosity
