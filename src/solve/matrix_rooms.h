// The rooms of a matrix: sets of patches that exchange light.
#pragma once

#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// The connected components of a symmetric matrix: the room of each patch, numbered from 0 by the
/// first patch stored. Light from one room never reaches another. The search walks once over the
/// stored entries and ends as soon as all patches are joined.
struct MatrixRooms {
  std::vector<Index> of_patch;  ///< N
  std::size_t count = 0;
};

/// Precondition: the symmetric form.
MatrixRooms matrixRooms(const ExchangeMatrix& matrix);

}  // namespace radiosity
