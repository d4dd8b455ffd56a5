// Pairs of values -> the figures of a comparison.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radiosity/compare.h"

namespace radiosity {

/// The two values of a cell or pixel, and what they weigh; weight 0: not compared.
struct ValuePair {
  double weight = 0;
  Vec3 a{0.0};
  Vec3 b{0.0};
  Vec3 place{0.0};
  Index surface = 0;
  bool emits = false;
};

/// Fills scale, fit, sums, largest, surfaces, difference and cells from the pairs, and names a
/// factor between them that has a name. `surface_names` may be empty (pictures).
void measureDifferences(std::vector<ValuePair>& pairs, const CompareOptions& options,
                        const std::vector<std::string>& surface_names, Comparison& comparison);

}  // namespace radiosity
