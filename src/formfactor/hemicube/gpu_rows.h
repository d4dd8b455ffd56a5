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

/// Writes down the place of an eye. `hidden`: as RowBuilder::place() gives it; `words`: zeros.
void describeEye(const PlacedEye& eye, std::span<const std::uint8_t> hidden, GpuView& view,
                 std::span<std::uint32_t> words);

/// The views of single eyes, in the form of Hemicube::look(). Holds memory: one a thread.
class GpuRowReader {
 public:
  /// View k < rows.count; `patches`: those of the scene. Valid until the next call.
  const HemicubeView& read(const GpuRows& rows, std::size_t k, std::size_t patches);

 private:
  std::vector<double> items_;
  HemicubeView view_;
};

/// Polygons that some hemicubes drew and skipped; hemicubes and pixels stay 0.
HemicubeReport polygonCounts(const GpuCounts& counts);

/// Looks from `patches` (not empty ones) and calls store(patch, view, counts) for each, on all
/// threads. The first patch of a batch gets the counts of polygons of all of it. Advances
/// `progress` by a step a patch and stops if that is cancelled. Returns why the device gave up, if
/// it did: some were then not called.
std::string lookFromPatches(
    GpuEye& eye, const RowBuilder& rows, std::span<const Index> patches,
    const std::function<void(std::size_t, const HemicubeView&, const HemicubeReport&)>& store,
    Progress& progress);

}  // namespace radiosity
