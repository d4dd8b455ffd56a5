#include "solve/matrix_rooms.h"

#include "matrix/run_row.h"
#include "mesh/union_find.h"

namespace radiosity {

MatrixRooms matrixRooms(const ExchangeMatrix& matrix) {
  const std::size_t n = matrix.size();
  UnionFind rooms_of(n);
  for (std::size_t k = 0; k < n && rooms_of.sets() > 1; ++k) {
    forRuns(matrix.upperRuns(k), [&](std::size_t offset, const auto* values, std::size_t count) {
      const std::size_t first = k + 1 + offset;
      for (std::size_t m = 0; m < count; ++m) {
        if (values[m] != 0) rooms_of.unite(Index(k), Index(first + m));
      }
    });
  }
  MatrixRooms rooms{std::vector<Index>(n), 0};
  std::vector<Index> number(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Index root = rooms_of.find(Index(k));
    if (root == k) number[k] = Index(rooms.count++);
    rooms.of_patch[matrix.order()[k]] = number[root];
  }
  return rooms;
}

}  // namespace radiosity
