// Pairs of values -> the figures of a comparison.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/compare.h"

namespace radiosity {

/// The weight of a cell's or pixel's two values, and its place; weight 0: not compared.
struct PairWeight {
  double weight = 0;
  Vec3 place{0.0};
  Index surface = 0;
  bool emits = false;
};

/// The two values of every cell or pixel, and their weights.
struct ValuePairs {
  ValuePairs(std::size_t count, int band_count)
      : bands(std::size_t(band_count)),
        weights(count),
        a(count * bands, 0.0),
        b(count * bands, 0.0) {}

  std::span<double> ofA(std::size_t k) { return {a.data() + k * bands, bands}; }
  std::span<double> ofB(std::size_t k) { return {b.data() + k * bands, bands}; }
  std::span<const double> ofA(std::size_t k) const { return {a.data() + k * bands, bands}; }
  std::span<const double> ofB(std::size_t k) const { return {b.data() + k * bands, bands}; }

  std::size_t bands;
  std::vector<PairWeight> weights;
  std::vector<double> a;  ///< pairs * bands
  std::vector<double> b;
};

/// Fills scale, fit, sums, largest, surfaces, difference and cells from the pairs, and names the
/// factor between them if it is a known one. `surface_names` may be empty (pictures).
void measureDifferences(ValuePairs& pairs, const CompareOptions& options,
                        const std::vector<std::string>& surface_names, Comparison& comparison);

}  // namespace radiosity
