#include "matrix/estimated_entries.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"

namespace radiosity {

double smallestArea(std::span<const double> area) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const double a : area) smallest = a > 0 ? std::min(smallest, a) : smallest;
  return smallest;
}

UncertainEntries estimatedEntries(const SymmetricMatrix& matrix,
                                  std::span<const std::uint8_t> known) {
  const std::size_t n = matrix.size();
  const double smallest = smallestArea(matrix.area());
  const auto isKnown = [&](Index patch) { return !known.empty() && known[patch] != 0; };
  UncertainEntries uncertain(n, matrix.scratch());
  parallelFor(n, 1, [&](std::size_t k) {
    const SymmetricMatrix::UpperEntries upper = matrix.upperEntries(k);
    const Index own = matrix.order()[k];
    const double share = smallest / matrix.area()[own];
    std::vector<Index> later;
    std::vector<double> errors;
    for (std::size_t m = 0; m < upper.positions.size() && !isKnown(own); ++m) {
      if (upper.positions[m] == k || isKnown(matrix.order()[upper.positions[m]])) continue;
      later.push_back(upper.positions[m]);
      errors.push_back(std::sqrt(upper.factors[m] * share));
    }
    uncertain.setRow(k, later, errors);
  });
  return uncertain;
}

}  // namespace radiosity
