// Gauss-Legendre rules of any order, made when first asked for.
#pragma once

#include <vector>

namespace radiosity::truth {

struct GaussPoint {
  long double x;       ///< in (0, 1)
  long double weight;  ///< they sum to 1
};

/// The rule with `points` points on (0, 1): the roots of the Legendre polynomial by Newton's
/// method, to long double. 1 to 32 points.
const std::vector<GaussPoint>& gaussRule(int points);

}  // namespace radiosity::truth
