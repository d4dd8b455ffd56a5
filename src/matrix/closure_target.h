// What closure may be asked for.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "radiosity/base.h"

namespace radiosity {

/// InputError unless there is a finite sum >= 0 for each of `n` rows.
inline void checkClosureTarget(std::span<const double> target, std::size_t n) {
  if (target.size() != n) {
    throw InputError(fmt::format("closure: {} row sums for {} rows", target.size(), n));
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (!(target[i] >= 0) || !std::isfinite(target[i])) {
      throw InputError(fmt::format("closure: {} is no sum for row {}", target[i], i));
    }
  }
}

}  // namespace radiosity
