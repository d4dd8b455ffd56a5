// Sparse rows as lines of row, column and value.
#include <fmt/format.h>

#include <iterator>

#include "base/printable.h"
#include "results/checked_file.h"
#include "tables/table_rows.h"

namespace radiosity {

void writeTriplets(const std::string& path, const NamedFactors& factors, Progress& progress) {
  const std::size_t n = factors.size();
  CheckedFile file(path);
  file.write(fmt::format(
      "# Form factors by radiosity: i, j, F[i,j], the fraction of what leaves i that reaches j.\n"
      "# Numbered from 0; j = {} is the sky, j = {} are black backs. Rows:\n",
      n, n + 1));
  for (std::size_t i = 0; i < n; ++i) {
    file.write(
        fmt::format("# {} {} m^2 {}\n", i, factors.matrix->area()[i], printable(factors.names[i])));
  }
  progress.begin("writing triplets", n);
  factors.matrix->forPanels([&](const RowPanel& rows) {
    for (std::size_t i = rows.first(); i < rows.last(); ++i) {
      progress.check();
      fmt::memory_buffer lines;
      const auto add = [&](std::size_t j, double value) {
        if (value != 0) fmt::format_to(std::back_inserter(lines), "{} {} {}\n", i, j, value);
      };
      rows.forRow(i, [&](Index j, double value) { add(j, value); });
      add(n, factors.sky[i]);
      add(n + 1, factors.backs[i]);
      file.write(lines.data(), lines.size());
      progress.advance();
    }
  });
  progress.end();
  file.commit();
}

}  // namespace radiosity
