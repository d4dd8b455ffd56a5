#include "elements/source_map.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

void SourceMap::layOut() {
  const ElementRoots& roots = surface_.roots;
  side_.resize(roots.size());
  first_.assign(1, 0);
  for (std::size_t r = 0; r < roots.size(); ++r) {
    double longest = 0;
    const std::size_t n = roots.cornerCount(r);
    for (std::size_t k = 0; k < n; ++k) {
      longest =
          std::max(longest, glm::distance(surface_.points[surface_.vertex[r][k]].place,
                                          surface_.points[surface_.vertex[r][(k + 1) % n]].place));
    }
    const double cells = surface_.diagonal > 0 ? longest / (kCellEdge * surface_.diagonal) : 1;
    side_[r] = std::uint8_t(std::clamp(std::ceil(cells), 1.0, double(kMostSide)));
    first_.push_back(first_.back() + std::size_t(side_[r]) * side_[r]);
  }
}

}  // namespace radiosity
