#include "solve/matrix_rooms.h"

#include <cstdint>
#include <numeric>

#include "matrix/run_row.h"

namespace radiosity {

namespace {

/// Sets of positions that grow together; each is known by its smallest position.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n), count_(n) {
    std::iota(parent_.begin(), parent_.end(), Index(0));
  }
  Index rootOf(Index k) {
    while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
    return k;
  }
  void join(Index a, Index b) {
    a = rootOf(a);
    b = rootOf(b);
    if (a == b) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --count_;
  }
  std::size_t count() const { return count_; }

 private:
  std::vector<Index> parent_;
  std::size_t count_;
};

}  // namespace

MatrixRooms matrixRooms(const ExchangeMatrix& matrix) {
  const std::size_t n = matrix.size();
  Sets sets(n);
  for (std::size_t k = 0; k < n && sets.count() > 1; ++k) {
    forRuns(matrix.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      const std::size_t first = k + 1 + offset;
      for (std::size_t m = 0; m < count; ++m) {
        if (values[m] != 0) sets.join(Index(k), Index(first + m));
      }
    });
  }
  MatrixRooms rooms{std::vector<Index>(n), 0};
  std::vector<Index> number(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Index root = sets.rootOf(Index(k));
    if (root == k) number[k] = Index(rooms.count++);
    rooms.of_patch[matrix.order()[k]] = number[root];
  }
  return rooms;
}

}  // namespace radiosity
