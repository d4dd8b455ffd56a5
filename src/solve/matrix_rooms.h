// Which patches are joined by exchange of light.
#pragma once

#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

/// The connected components of a symmetric matrix: the room of each patch, numbered from 0 by the
/// first patch stored. Light from one never reaches another. One walk over what is stored, which
/// ends as soon as all patches are joined.
struct MatrixRooms {
  std::vector<Index> of_patch;  ///< N
  std::size_t count = 0;
};

/// Precondition: the symmetric form.
MatrixRooms matrixRooms(const ExchangeMatrix& matrix);

}  // namespace radiosity
