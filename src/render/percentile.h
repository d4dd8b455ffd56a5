// Order statistics.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace radiosity {

/// Nearest rank: the smallest value such that at least this share of the values does not exceed it.
/// 0 < share <= 1. `values`: one or more; they are reordered.
inline double percentile(std::vector<double>& values, double share) {
  const auto rank = std::size_t(std::ceil(share * double(values.size()))) - 1;
  const auto at = values.begin() + std::ptrdiff_t(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace radiosity
