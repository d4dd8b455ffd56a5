#include "lightmap/chart_packing.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radiosity/lightmap.h"

namespace radiosity {
namespace {

int texelsOf(double metres, double texels_per_metre) {
  return std::max(1, int(std::ceil(metres * texels_per_metre))) + 2 * kLightmapPadding;
}

/// Fills shelves with the charts in `order`, from the highest to the lowest. False if they do not
/// fit.
bool fillShelves(std::span<const Chart> charts, std::span<const Index> order, int size,
                 ChartPacking& packing) {
  packing.places.resize(charts.size());
  int x = 0;
  int y = 0;
  int shelf = 0;
  for (const Index c : order) {
    ChartPlace& place = packing.places[c];
    place.width = texelsOf(charts[c].size.x, packing.texels_per_metre);
    place.height = texelsOf(charts[c].size.y, packing.texels_per_metre);
    if (place.width > size) return false;
    if (x + place.width > size) {
      y += shelf;
      x = shelf = 0;
    }
    if (y + place.height > size) return false;
    place.x = x;
    place.y = y;
    x += place.width;
    shelf = std::max(shelf, place.height);
  }
  return true;
}

}  // namespace

int leastMapSize(std::size_t charts) {
  constexpr int kLeast = 1 + 2 * kLightmapPadding;
  return kLeast * int(std::ceil(std::sqrt(double(charts))));
}

std::optional<ChartPacking> packCharts(std::span<const Chart> charts, int size) {
  std::vector<Index> order(charts.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return charts[a].size.y > charts[b].size.y; });
  ChartPacking best;
  if (!fillShelves(charts, order, size, best)) return std::nullopt;
  double area = 0;
  for (const Chart& chart : charts) area += chart.size.x * chart.size.y;
  if (!(area > 0)) return best;
  // The density of a completely filled map is an upper bound. After this many halvings the interval
  // is far below a hundredth of a texel.
  constexpr int kHalvings = 40;
  double none = 1.01 * double(size) / std::sqrt(area);
  for (int k = 0; k < kHalvings; ++k) {
    ChartPacking trial;
    trial.texels_per_metre = 0.5 * (best.texels_per_metre + none);
    if (fillShelves(charts, order, size, trial)) {
      best = std::move(trial);
    } else {
      none = trial.texels_per_metre;
    }
  }
  return best;
}

}  // namespace radiosity
