// A matrix from its entries in any order.
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

/// Row form, double precision. InputError naming the file and the entry for one given twice.
ExchangeMatrix matrixOfEntries(const std::string& path, std::vector<Entry> entries,
                               std::vector<double> area);

}  // namespace radiosity
