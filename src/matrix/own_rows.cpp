#include "matrix/own_rows.h"

#include <algorithm>

#include "base/union_find.h"
#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"

namespace radiosity {

double sumRow(const ExchangeMatrix& own, std::size_t k, std::size_t begin,
              std::span<const double> ones, std::span<double> handed_on) {
  const double area = own.area()[own.order()[k]];
  const RowBlock row{.rows = {&own.upperRuns(k), 1}, .first = k + 1 - begin};
  const RowOperands operands{.x = ones.data(),
                             .x_stride = ones.size(),
                             .z = handed_on.data(),
                             .z_stride = handed_on.size(),
                             .bands = 1};
  static const TriangleKernels kernels = triangleKernels();
  double sum = 0;
  kernels.gather_and_hand_on(row, operands, &area, &sum);
  return sum + own.diagonal(k);
}

void transposedProduct(const ExchangeMatrix& own, std::span<const double> x, int bands,
                       std::span<double> y) {
  const auto width = std::size_t(bands);
  if (!own.isSymmetric()) {
    std::fill(y.begin(), y.end(), 0.0);
    forOwnEntries(own, [&](std::size_t i, std::size_t j, double value) {
      for (std::size_t b = 0; b < width; ++b) y[j * width + b] += value * x[i * width + b];
    });
    return;
  }
  // F = A^-1 G with G symmetric: F^T x = A F A^-1 x.
  std::vector<double> per_area(x.begin(), x.end());
  for (std::size_t k = 0; k < per_area.size(); ++k) {
    const double area = own.area()[k / width];
    per_area[k] = area > 0 ? per_area[k] / area : 0.0;
  }
  own.product(per_area, bands, y);
  for (std::size_t k = 0; k < y.size(); ++k) y[k] *= own.area()[k / width];
}

void forOwnEntries(const ExchangeMatrix& own,
                   const std::function<void(std::size_t, std::size_t, double)>& visit) {
  if (!own.isSymmetric()) {
    own.forPanels([&](const RowPanel& rows) {
      for (std::size_t i = rows.first(); i < rows.last(); ++i) {
        rows.forRow(i, [&](Index j, double value) { visit(i, j, value); });
      }
    });
    return;
  }
  const std::span<const Index> order = own.order();
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (own.diagonal(k) != 0) visit(order[k], order[k], own.diagonal(k));
    const double area = own.area()[order[k]];
    forRuns(own.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      for (std::size_t m = 0; m < count; ++m) {
        if (values[m] == 0) continue;
        const Index later = order[k + 1 + offset + m];
        visit(order[k], later, double(values[m]));
        visit(later, order[k], double(values[m]) * area / own.area()[later]);
      }
    });
  }
}

std::vector<Index> joinedBy(const ExchangeMatrix& own) {
  const std::size_t n = own.size();
  UnionFind sets(n);
  for (std::size_t k = 0; k < n && sets.sets() > 1; ++k) {
    forRuns(own.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      const std::size_t first = k + 1 + offset;
      for (std::size_t m = 0; m < count; ++m) {
        if (values[m] != 0) sets.unite(Index(k), Index(first + m));
      }
    });
  }
  std::vector<Index> joined(n);
  for (std::size_t k = 0; k < n; ++k) joined[k] = sets.find(Index(k));
  return joined;
}

}  // namespace radiosity
