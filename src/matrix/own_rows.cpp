#include "matrix/own_rows.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "matrix/run_row.h"
#include "matrix/triangle_kernels.h"

namespace radiosity {

namespace {

/// Positions that are compared with a row at once.
constexpr std::size_t kLabelBlock = 512;

/// Disjoint sets of positions. All positions of a set have one label, so that a stretch of a row is
/// compared in a few vector instructions: nearly all of a matrix's pairs are in one set already.
class LabelledSets {
 public:
  explicit LabelledSets(std::size_t positions)
      : label_(positions), next_(positions), size_(positions, 1), count_(positions) {
    std::iota(label_.begin(), label_.end(), Index(0));
    std::iota(next_.begin(), next_.end(), Index(0));
  }
  std::size_t count() const { return count_; }

  /// Whether positions [first, last) are all in the set of k.
  bool together(std::size_t k, std::size_t first, std::size_t last) const {
    const Index own = label_[k];
    Index different = 0;
    for (std::size_t q = first; q < last; ++q) different |= label_[q] ^ own;
    return different == 0;
  }

  void unite(std::size_t a, std::size_t b) {
    if (label_[a] == label_[b]) return;
    if (size_[label_[a]] < size_[label_[b]]) std::swap(a, b);
    const Index kept = label_[a];
    size_[kept] += size_[label_[b]];
    Index at = Index(b);
    do {
      label_[at] = kept;
      at = next_[at];
    } while (at != b);
    std::swap(next_[a], next_[b]);  // two rings become one
    --count_;
  }

  /// The first position in the set of each.
  std::vector<Index> firsts() const {
    std::vector<Index> first_of(label_.size(), kNone);
    std::vector<Index> firsts;
    for (Index k = 0; k < label_.size(); ++k) {
      Index& first = first_of[label_[k]];
      if (first == kNone) first = k;
      firsts.push_back(first);
    }
    return firsts;
  }

 private:
  std::vector<Index> label_;
  std::vector<Index> next_;  // a ring through the positions of each set
  std::vector<Index> size_;  // by label
  std::size_t count_;
};

}  // namespace

double sumRow(const SymmetricMatrix& own, std::size_t k, std::size_t begin,
              std::span<const double> ones, std::span<double> scattered) {
  const double area = own.area()[own.order()[k]];
  const RowBlock row{.rows = {&own.upperRuns(k), 1}, .first = k + 1 - begin};
  const RowOperands operands{.x = ones.data(),
                             .x_stride = ones.size(),
                             .z = scattered.data(),
                             .z_stride = scattered.size(),
                             .bands = 1};
  static const TriangleKernels kernels = triangleKernels();
  double sum = 0;
  kernels.gather_and_scatter(row, operands, &area, &sum);
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
  const auto* const triangle = dynamic_cast<const SymmetricMatrix*>(&own);
  if (triangle == nullptr) {
    own.forPanels([&](const RowPanel& rows) {
      for (std::size_t i = rows.first(); i < rows.last(); ++i) {
        rows.forRow(i, [&](Index j, double value) { visit(i, j, value); });
      }
    });
    return;
  }
  const std::span<const Index> order = own.order();
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (triangle->diagonal(k) != 0) visit(order[k], order[k], triangle->diagonal(k));
    const double area = own.area()[order[k]];
    forRuns(triangle->upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      for (std::size_t m = 0; m < count; ++m) {
        if (values[m] == 0) continue;
        const Index later = order[k + 1 + offset + m];
        visit(order[k], later, double(values[m]));
        visit(later, order[k], double(values[m]) * area / own.area()[later]);
      }
    });
  }
}

std::vector<Index> joinedBy(const SymmetricMatrix& own) {
  const std::size_t n = own.size();
  LabelledSets sets(n);
  for (std::size_t k = 0; k < n && sets.count() > 1; ++k) {
    forRuns(own.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      const std::size_t first = k + 1 + offset;
      for (std::size_t begin = 0; begin < count; begin += kLabelBlock) {
        const std::size_t end = std::min(count, begin + kLabelBlock);
        if (sets.together(k, first + begin, first + end)) continue;
        for (std::size_t m = begin; m < end; ++m) {
          if (values[m] != 0) sets.unite(k, first + m);
        }
      }
    });
  }
  return sets.firsts();
}

ExchangeOperator::Rooms roomsOf(std::span<const Index> first, std::span<const Index> order) {
  ExchangeOperator::Rooms rooms{std::vector<Index>(first.size()), 0};
  std::vector<Index> number(first.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] == k) number[k] = Index(rooms.count++);
    rooms.of_patch[order[k]] = number[first[k]];
  }
  return rooms;
}

}  // namespace radiosity
