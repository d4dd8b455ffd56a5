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

std::optional<std::uint32_t> SourceMap::cellAt(std::size_t patch, const Vec3& at) const {
  const ElementRoots& roots = surface_.roots;
  if (roots.of_patch[patch] == roots.of_patch[patch + 1]) return std::nullopt;
  const std::size_t root = lookup_.rootAt(patch, at);
  const int n = side_[root];
  int x = 0;
  int y = 0;
  if (n > 1) {
    const Vec2 place = lookup_.place(root, at);
    x = std::min(int(place.x * n), n - 1);
    y = std::min(int(place.y * n), n - 1);
  }
  return std::uint32_t(first_[root] + std::size_t(y * n + x));
}

}  // namespace radiosity
