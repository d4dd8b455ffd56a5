// The eyes of timed hemicubes.
#pragma once

#include <cstddef>
#include <vector>

#include "formfactor/hemicube/row_builder.h"
#include "radiosity/form_factors.h"

namespace radiosity::bench {

inline constexpr std::size_t kEyes = 24;

inline std::size_t pixelsOf(int resolution) {
  return 3 * std::size_t(resolution) * std::size_t(resolution);
}

inline FormFactorOptions optionsFor(int resolution) {
  FormFactorOptions options;
  options.method = FormFactorMethod::hemicube;
  options.resolution = resolution;
  return options;
}

/// Eyes spread evenly over the patches.
inline std::vector<std::size_t> chooseEyes(const PatchMesh& mesh, const RowBuilder& rows) {
  std::vector<std::size_t> eyes;
  for (std::size_t k = 0; k < kEyes; ++k) {
    const std::size_t patch = (2 * k + 1) * mesh.size() / (2 * kEyes);
    if (!rows.isEmpty(patch)) eyes.push_back(patch);
  }
  return eyes;
}

inline EyeFrame frameOf(const PatchMesh& mesh, const RowBuilder& rows, std::size_t patch) {
  return eyeFrame(mesh.centroid[patch] * rows.scene().scale, mesh.normal[patch],
                  turnAngle(mesh, patch, 1));
}

}  // namespace radiosity::bench
