// Writes the NIST Matrix Market exchange format (Boisvert, Pozo & Remington 1996, NISTIR 5935).
#include "results/matrix_market.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "base/parallel.h"
#include "radiosity/results.h"
#include "results/checked_file.h"

namespace radiosity {

namespace {

/// The number of entries that one task formats at a time, about 2 MB of text.
constexpr std::size_t kTaskEntries = std::size_t(1) << 16;
/// The number of tasks whose text is held before it is written. It is fixed, so that memory is the
/// same for any number of threads.
constexpr std::size_t kTasks = 16;

std::size_t entriesOf(const RowPanel& rows, std::size_t i) {
  std::size_t entries = 0;
  rows.forRow(i, [&](Index, double) { ++entries; });
  return entries;
}

/// Formats a row with exactly the values of a results file, rounded to the matrix's precision: one
/// side of each pair of a symmetric matrix is computed, not stored.
void formatRow(const RowPanel& rows, bool single, std::size_t i, fmt::memory_buffer& text) {
  const fmt::format_int row(i + 1);
  rows.forRow(i, [&](Index column, double value) {
    text.append(row.data(), row.data() + row.size());
    text.push_back(' ');
    const fmt::format_int number(std::size_t(column) + 1);
    text.append(number.data(), number.data() + number.size());
    text.push_back(' ');
    fmt::format_to(std::back_inserter(text), "{:.17g}\n", single ? double(float(value)) : value);
  });
}

/// Formats rows from `first` on in up to kTasks parallel tasks and writes them in order; returns
/// the first row that is left.
std::size_t writeBatch(CheckedFile& file, const RowPanel& rows, bool single, std::size_t first,
                       std::vector<fmt::memory_buffer>& texts) {
  std::vector<std::size_t> starts = {first};
  std::size_t row = first;
  while (row < rows.last() && starts.size() <= texts.size()) {
    std::size_t entries = 0;
    while (row < rows.last() && entries < kTaskEntries) entries += entriesOf(rows, row++);
    starts.push_back(row);
  }
  const std::size_t tasks = starts.size() - 1;
  parallelFor(tasks, 1, [&](std::size_t t) {
    texts[t].clear();
    for (std::size_t i = starts[t]; i < starts[t + 1]; ++i) formatRow(rows, single, i, texts[t]);
  });
  for (std::size_t t = 0; t < tasks; ++t) file.write(texts[t].data(), texts[t].size());
  return row;
}

}  // namespace

void writeMatrixMarket(const std::string& path, const ExchangeMatrix& matrix, Progress& progress) {
  writeMatrixMarket(path, matrix, {}, progress);
}

void writeMatrixMarket(const std::string& path, const ExchangeMatrix& matrix,
                       const CommentOfRow& comment, Progress& progress) {
  CheckedFile file(path);
  const std::size_t n = matrix.size();
  const bool single = matrix.precision() == Precision::single_precision;
  file.write(fmt::format(
      "%%MatrixMarket matrix coordinate real general\n"
      "% Form factors by radiosity: row i, column j holds F[i,j], the fraction of what\n"
      "% leaves patch i that reaches patch j; no unit. Patches are numbered from 1.\n"
      "% The values as stored, {} bits, in 17 digits.\n",
      single ? 32 : 64));
  for (std::size_t i = 0; comment && i < n; ++i) file.write(fmt::format("% {}\n", comment(i)));
  file.write(fmt::format("{} {} {}\n", n, n, matrix.nonZeros()));
  progress.begin("writing MatrixMarket", n);
  std::vector<fmt::memory_buffer> texts(kTasks);
  matrix.forPanels([&](const RowPanel& rows) {
    for (std::size_t row = rows.first(); row < rows.last();) {
      progress.check();
      const std::size_t next = writeBatch(file, rows, single, row, texts);
      progress.advance(next - row);
      row = next;
    }
  });
  progress.end();
  file.commit();
}

}  // namespace radiosity
