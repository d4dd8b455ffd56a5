// The reflected light of each part of the surfaces, for look-ups by rays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "elements/surface_points.h"
#include "radiosity/elements.h"

namespace radiosity {

/// Reflectance times irradiance, as means over the cells of a grid on each root. A ray reads one
/// cell: a walk down the trees of elements would take longer than the ray. Cells are no longer than
/// kCellEdge of the scene's diagonal, unless that takes more than kMostSide cells a side.
class SourceMap {
 public:
  static constexpr double kCellEdge = 0.01;
  static constexpr int kMostSide = 16;

  /// `light(root, place, sum)` adds the irradiance at a place of a root to `sum`, several at once.
  template <class Light>
  SourceMap(const ElementSurface& surface, const ElementLookup& lookup,
            const PatchMaterials& materials, bool emission, const Light& light)
      : surface_(surface), lookup_(lookup), bands_(std::size_t(materials.bands)) {
    layOut();
    fill(materials, emission, light);
  }

  int bands() const { return int(bands_); }
  /// The cell of a point of a patch; the same in all maps of one surface. Nothing if the patch has
  /// no roots.
  std::optional<std::uint32_t> cellAt(std::size_t patch, const Vec3& at) const;
  /// Adds the light that leaves a cell to `sum` (bands).
  void add(std::uint32_t cell, std::span<double> sum) const {
    const float* values = values_.data() + cell * bands_;
    for (std::size_t b = 0; b < bands_; ++b) sum[b] += double(values[b]);
  }

 private:
  void layOut();
  template <class Light>
  void fill(const PatchMaterials& materials, bool emission, const Light& light);

  const ElementSurface& surface_;
  const ElementLookup& lookup_;
  std::size_t bands_;
  std::vector<std::uint8_t> side_;  ///< R
  std::vector<std::size_t> first_;  ///< R + 1, cells
  std::vector<float> values_;       ///< cells * bands
};

template <class Light>
void SourceMap::fill(const PatchMaterials& materials, bool emission, const Light& light) {
  constexpr int kSamples = 4;  // along each side of a cell
  values_.assign(first_.back() * bands_, 0.0F);
  parallelFor(side_.size(), 16, [&](std::size_t r) {
    const int n = side_[r];
    const std::size_t patch = surface_.roots.patch[r];
    const bool quad = surface_.roots.cornerCount(r) == 4;
    std::vector<double> mean(bands_);
    for (int c = 0; c < n * n; ++c) {
      std::fill(mean.begin(), mean.end(), 0.0);
      int counted = 0;
      const auto sample = [&](Vec2 at) {
        light(r, at, std::span<double>(mean));
        ++counted;
      };
      const int row = c / n;
      const Vec2 corner(c % n, row);
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const int line = s / kSamples;
        const Vec2 in_cell = Vec2(s % kSamples + 0.5, line + 0.5) / double(kSamples);
        const Vec2 at = (corner + in_cell) / double(n);
        if (quad || at.x + at.y <= 1) sample(at);
      }
      // Rounding may put a place into a cell outside the triangle.
      if (counted == 0) sample(Vec2(corner.x, n - 1 - corner.x) / double(n));
      float* cell = values_.data() + (first_[r] + std::size_t(c)) * bands_;
      for (std::size_t b = 0; b < bands_; ++b) {
        const std::size_t k = patch * bands_ + b;
        cell[b] = float(materials.reflectance[k] * mean[b] / counted +
                        (emission ? materials.emission[k] : 0.0));
      }
    }
  });
}

}  // namespace radiosity
