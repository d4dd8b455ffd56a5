#include "formfactor/hemicube/gpu_rows.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>

#include "base/parallel.h"

namespace radiosity {

void describeEye(const PlacedEye& eye, std::span<const std::uint8_t> hidden, GpuView& view,
                 std::span<std::uint32_t> words) {
  for (std::size_t k = 0; k < 3; ++k) {
    view.eye[k] = eye.frame.eye[int(k)];
    for (std::size_t column = 0; column < 3; ++column) {
      view.axes[3 * column + k] = eye.frame.axes[int(column)][int(k)];
    }
  }
  view.own = eye.own;
  for (std::size_t p = 0; p < hidden.size(); ++p) {
    words[p / 32] |= std::uint32_t(hidden[p] != 0) << (p % 32);
  }
}

const HemicubeView& GpuRowReader::read(const GpuRows& rows, std::size_t k, std::size_t patches) {
  const std::size_t weights = rows.low.size() / rows.count;
  items_.resize(weights - 1);
  view_.fronts = view_.backs = 0;
  for (std::size_t item = 0; item < items_.size(); ++item) {
    items_[item] = kGpuUnit * double(rows.weight(k * weights + item));
    (item < patches ? view_.fronts : view_.backs) += items_[item];
  }
  view_.sky = kGpuUnit * double(rows.weight((k + 1) * weights - 1));
  view_.items = items_;
  return view_;
}

HemicubeReport polygonCounts(const GpuCounts& counts) {
  HemicubeReport polygons;
  polygons.rasterised_polygons = counts.rasterised;
  polygons.skipped_own_plane = counts.own_plane;
  polygons.skipped_horizon = counts.horizon;
  polygons.skipped_facing_away = counts.facing_away;
  polygons.skipped_face = counts.face;
  return polygons;
}

std::string lookFromPatches(
    GpuEye& eye, const RowBuilder& rows, std::span<const Index> patches,
    const std::function<void(std::size_t, const HemicubeView&, const HemicubeReport&)>& store,
    Progress& progress) {
  const auto resolution = std::size_t(rows.weights().resolution());
  std::vector<std::uint8_t> hidden;
  tbb::enumerable_thread_specific<GpuRowReader> readers;
  return eye.look(
      patches.size(),
      [&](std::size_t k, GpuView& view, std::span<std::uint32_t> words) {
        const PlacedEye placed = rows.eyeOf(patches[k], hidden);
        describeEye(placed, hidden, view, words);
      },
      [&](const GpuRows& seen) {
        parallelFor(seen.count, 1, [&](std::size_t k) {
          const HemicubeView& view = readers.local().read(seen, k, rows.scene().patches);
          HemicubeReport counts = k == 0 ? polygonCounts(seen.counts) : HemicubeReport();
          counts.hemicubes = 1;
          counts.pixels = 3 * resolution * resolution;
          store(patches[seen.first + k], view, counts);
        });
        progress.advance(seen.count);
        return !progress.cancelled();
      });
}

}  // namespace radiosity
