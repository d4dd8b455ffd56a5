// A stored row of the row form.
#pragma once

#include <cstddef>
#include <memory_resource>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

inline std::size_t valueBytes(Precision precision) {
  return precision == Precision::single_precision ? sizeof(float) : sizeof(double);
}

/// The values are in `floats` or in `doubles`, by precision.
struct ExchangeMatrix::Row {
  explicit Row(std::pmr::memory_resource* memory)
      : columns(memory), floats(memory), doubles(memory) {}

  std::pmr::vector<Index> columns;  ///< empty for a dense row
  std::pmr::vector<float> floats;
  std::pmr::vector<double> doubles;
  bool dense = false;
};

}  // namespace radiosity
