#include "elements/source_cells.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace radiosity {

SourceCells::SourceCells(const ElementSurface& surface, const ElementLookup& lookup, int bands)
    : surface_(surface), lookup_(lookup), bands_(std::size_t(bands)) {
  constexpr double kLonger = 1.4;
  layOut(kCellEdge * surface.diagonal);
  while (size() > kMostCells + surface.roots.size()) layOut(kLonger * far_);
  values_.assign(2 * size() * bands_, 0.0F);
}

void SourceCells::layOut(double edge) {
  far_ = edge;
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
    const double cells = edge > 0 ? longest / edge : 1;
    side_[r] = std::uint8_t(std::clamp(std::ceil(cells), 1.0, double(kMostSide)));
    first_.push_back(first_.back() + std::size_t(side_[r]) * side_[r]);
  }
}

std::optional<std::uint32_t> SourceCells::sourceAt(std::size_t patch, const Vec3& at,
                                                   const Vec3& from) const {
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
    // Rounding may put a place beyond a triangle's longest side.
    if (roots.cornerCount(root) == 3) y = std::min(y, n - 1 - x);
  }
  const bool near = glm::distance(at, from) < far_;
  return std::uint32_t(2 * (first_[root] + std::size_t(y * n + x)) + (near ? 1 : 0));
}

}  // namespace radiosity
