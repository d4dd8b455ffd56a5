// Visits the rows of named form factors one after the other.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "radiosity/tables.h"

namespace radiosity {

/// The label of a row in a file: its name, or its number.
inline std::string labelOf(const NamedFactors& factors, std::size_t a) {
  return factors.numbered ? std::to_string(a) : factors.names[a];
}

/// Throws InputError if two receivers would have the same name.
void requireDistinctNames(const std::string& path, const NamedFactors& factors);
/// Throws InputError if a matrix of numbered rows has more values than kMostTableValues.
void requireTableSize(const std::string& path, const NamedFactors& factors);

/// Calls visit(a, row) with all N values of each row in order. `stage`: for the progress.
template <class Visit>
void forDenseRows(const NamedFactors& factors, const std::string& stage, Progress& progress,
                  Visit&& visit) {
  std::vector<double> row(factors.size());
  progress.begin(stage, factors.size());
  factors.matrix->forPanels([&](const RowPanel& rows) {
    for (std::size_t a = rows.first(); a < rows.last(); ++a) {
      progress.check();
      std::fill(row.begin(), row.end(), 0.0);
      rows.forRow(a, [&](Index b, double value) { row[b] = value; });
      visit(a, row);
      progress.advance();
    }
  });
  progress.end();
}

}  // namespace radiosity
