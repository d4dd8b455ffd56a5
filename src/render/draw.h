// Functions that all pictures of radiance use.
#pragma once

#include <string>

#include "render/samples.h"

namespace radiosity {

/// The picture of a field of three bands: every pixel is the mean of the samples that hit a
/// surface. `parts`, if not null, is filled.
Image drawField(const PatchMesh& mesh, const PatchField& field, const ItemBuffer& items,
                const RenderOptions& options, const std::string& stage, Progress& progress,
                PictureParts* parts = nullptr);

/// The radiance for values of exitance: B / pi.
std::vector<double> radianceOf(std::span<const double> exitance);

}  // namespace radiosity
