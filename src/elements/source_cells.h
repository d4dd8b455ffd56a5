// The light that leaves each part of the surfaces, for look-ups by rays.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "elements/surface_points.h"
#include "radiosity/elements.h"

namespace radiosity {

/// The radiosity of the cells of a grid on each root. A ray reads one cell: a walk down the trees
/// of elements would take longer than the ray. Cells are no longer than kCellEdge of the scene's
/// diagonal, unless that takes more than kMostSide cells a side.
///
/// A cell may be partly in a dark gap, and light that leaves it for the room leaves from its open
/// part. So its mean is too low as seen from afar, always in one direction and at every bounce. A
/// cell therefore has two radiosities: as seen by rays that are longer than the longest cells, its
/// mean weighted by the share of such rays among those that leave each place; as seen by shorter
/// ones, weighted by the share of these. Whether a ray is long is the same from both ends, so no
/// power is lost or gained.
class SourceCells {
 public:
  static constexpr double kCellEdge = 0.005;
  static constexpr int kMostSide = 32;
  /// Of all roots, besides one each: cells are made longer until they are no more.
  static constexpr std::size_t kMostCells = std::size_t(1) << 21;

  SourceCells(const ElementSurface& surface, const ElementLookup& lookup, int bands);

  int bands() const { return int(bands_); }
  std::size_t size() const { return first_.back(); }
  /// The cells of a root: side x side, row by row. Of a triangle only those with column + row <
  /// side hold a part.
  int side(std::size_t root) const { return side_[root]; }
  std::size_t first(std::size_t root) const { return first_[root]; }

  /// What a ray reads that ends at a place of a patch: a cell, from afar or from nearby. Nothing if
  /// the patch has no roots.
  std::optional<std::uint32_t> sourceAt(std::size_t patch, const Vec3& at, const Vec3& from) const;
  static bool isFar(std::uint32_t source) { return source % 2 == 0; }
  /// Adds the light that it gets to `sum` (bands).
  void add(std::uint32_t source, std::span<double> sum) const {
    const float* values = values_.data() + std::size_t(source) * bands_;
    for (std::size_t b = 0; b < bands_; ++b) sum[b] += double(values[b]);
  }

  /// Size() * 2 * bands: of each cell as seen from afar, then from nearby.
  std::vector<float>& values() { return values_; }

 private:
  void layOut(double edge);

  const ElementSurface& surface_;
  const ElementLookup& lookup_;
  std::size_t bands_;
  double far_ = 0;                  ///< metres: the edge of cells
  std::vector<std::uint8_t> side_;  ///< R
  std::vector<std::size_t> first_;  ///< R + 1
  std::vector<float> values_;
};

}  // namespace radiosity
