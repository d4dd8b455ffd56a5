// Rows of the form-factor matrix by the GPU's eye.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "formfactor/hemicube/gpu_eye.h"
#include "formfactor/hemicube/hemicube.h"
#include "formfactor/hemicube/row_builder.h"

namespace radiosity {

/// Writes down where an eye stands. `hidden`: as RowBuilder::place() gives it; `words`: zeros.
void describeEye(const PlacedEye& eye, std::span<const std::uint8_t> hidden, GpuView& view,
                 std::span<std::uint32_t> words);

/// What single eyes of some rows see, in the form that Hemicube::look() has. Memory: one a thread.
class GpuRowReader {
 public:
  /// Of view k < rows.count; `patches`: of the scene. Valid until the next call.
  const HemicubeView& read(const GpuRows& rows, std::size_t k, std::size_t patches);

 private:
  std::vector<double> items_;
  HemicubeView view_;
};

/// Polygons that some hemicubes drew and skipped; no hemicubes and pixels.
HemicubeCounts polygonCounts(const GpuCounts& counts);

/// Looks from `patches` (not empty ones) and calls store(patch, view, counts) for each of them, on
/// all threads. Counts of polygons are told with the first patch of a batch, for all of it;
/// HemicubeCounts::sky_pixels is 1 for any number of them. Advances `progress` by a step a patch
/// and stops where that is cancelled. Empty, or why the device gave up: then some were not called.
std::string lookFromPatches(
    GpuEye& eye, const RowBuilder& rows, std::span<const Index> patches,
    const std::function<void(std::size_t, const HemicubeView&, const HemicubeCounts&)>& store,
    Progress& progress);

}  // namespace radiosity
