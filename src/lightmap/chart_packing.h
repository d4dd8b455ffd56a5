// The places of charts in the map.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lightmap/charts.h"

namespace radiosity {

/// Texels of a chart with its padding.
struct ChartPlace {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

struct ChartPacking {
  double texels_per_metre = 0;
  std::vector<ChartPlace> places;  ///< of each chart; no two share a texel
};

/// Packs charts on shelves into a square of `size` texels, at the largest common density that fits.
/// Empty if charts of a single texel with their padding do not fit. Shelves are filled from the
/// highest chart to the lowest (next fit, decreasing height: Coffman, Garey, Johnson & Tarjan 1980,
/// which leaves at most about half empty). O(n log n).
std::optional<ChartPacking> packCharts(std::span<const Chart> charts, int size);

/// The least size of a map with room for this number of charts.
int leastMapSize(std::size_t charts);

}  // namespace radiosity
