// A row of the row form as it is stored.
#pragma once

#include <cstddef>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

inline std::size_t valueBytes(Precision precision) {
  return precision == Precision::single_precision ? sizeof(float) : sizeof(double);
}

/// The values are in `floats` or in `doubles`, by precision.
struct ExchangeMatrix::Row {
  std::vector<Index> columns;  ///< empty for a dense row
  std::vector<float> floats;
  std::vector<double> doubles;
  bool dense = false;
};

}  // namespace radiosity
