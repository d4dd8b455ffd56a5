// Makes a matrix from its entries in any order.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/row_matrix.h"

namespace radiosity {

struct Entry {
  Index row = 0;
  Index column = 0;
  double value = 0;
};

/// In double precision. Errors: InputError naming the file and an entry that is given twice.
RowMatrix matrixOfEntries(const std::string& path, std::vector<Entry> entries,
                          std::vector<double> area);

}  // namespace radiosity
