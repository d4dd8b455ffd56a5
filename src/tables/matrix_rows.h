// Makes a matrix from its entries in any order.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "radiosity/exchange_matrix.h"

namespace radiosity {

struct Entry {
  Index row = 0;
  Index column = 0;
  double value = 0;
};

/// Row form, double precision. Errors: InputError naming the file and an entry that is given twice.
ExchangeMatrix matrixOfEntries(const std::string& path, std::vector<Entry> entries,
                               std::vector<double> area);

}  // namespace radiosity
