#include "solve/matrix_rooms.h"

#include "matrix/own_rows.h"
#include "matrix/shared_rows.h"

namespace radiosity {

MatrixRooms matrixRooms(const ExchangeMatrix& matrix) {
  const SharedRows* const shared = matrix.sharedRows();
  const std::vector<Index> first = shared != nullptr ? shared->joined() : joinedBy(matrix);
  MatrixRooms rooms{std::vector<Index>(first.size()), 0};
  std::vector<Index> number(first.size());
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] == k) number[k] = Index(rooms.count++);
    rooms.of_patch[matrix.order()[k]] = number[first[k]];
  }
  return rooms;
}

}  // namespace radiosity
