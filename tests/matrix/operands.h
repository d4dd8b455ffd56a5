// Vectors that the tests of the matrix multiply by, and precisions.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity::test {

inline constexpr Precision kPrecisions[] = {Precision::single_precision,
                                            Precision::double_precision};

inline std::vector<double> randomVector(std::size_t n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0.5, 2.0);
  std::vector<double> values(n);
  for (double& value : values) value = uniform(random);
  return values;
}

}  // namespace radiosity::test
