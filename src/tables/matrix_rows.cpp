#include "tables/matrix_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/parallel.h"

namespace radiosity {

namespace {

/// The first entry of each row in entries sorted by row, and the end of the last row.
std::vector<std::size_t> rowStarts(const std::vector<Entry>& entries, std::size_t rows) {
  std::vector<std::size_t> starts(rows + 1, 0);
  for (const Entry& entry : entries) ++starts[entry.row + 1];
  for (std::size_t i = 0; i < rows; ++i) starts[i + 1] += starts[i];
  return starts;
}

}  // namespace

RowMatrix matrixOfEntries(const std::string& path, std::vector<Entry> entries,
                          std::vector<double> area) {
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.row, a.column) < std::tie(b.row, b.column);
  });
  const auto twice = std::adjacent_find(
      entries.begin(), entries.end(),
      [](const Entry& a, const Entry& b) { return a.row == b.row && a.column == b.column; });
  if (twice != entries.end()) {
    throw InputError(fmt::format("{}: row {}, column {} is given twice; give each entry once", path,
                                 twice->row + 1, twice->column + 1));
  }
  RowMatrix matrix(std::move(area), Precision::double_precision);
  const std::vector<std::size_t> starts = rowStarts(entries, matrix.size());
  parallelFor(matrix.size(), 64, [&](std::size_t i) {
    std::vector<Index> columns;
    std::vector<double> values;
    for (std::size_t k = starts[i]; k < starts[i + 1]; ++k) {
      if (!(entries[k].value > 0)) continue;
      columns.push_back(entries[k].column);
      values.push_back(entries[k].value);
    }
    matrix.setRow(i, columns, values);
  });
  return matrix;
}

}  // namespace radiosity
