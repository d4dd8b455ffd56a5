// Sparse rows as datasets of row, column and value.
#include <algorithm>
#include <numeric>

#include "base/atomic_file.h"
#include "results/column_writer.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

using h5::Number;

void writeEntries(h5::OutputGroup& root, const ExchangeMatrix& matrix, Progress& progress) {
  const std::vector<Index> entries = matrix.rowEntries();
  const std::size_t total = std::accumulate(entries.begin(), entries.end(), std::size_t(0));
  h5::ColumnWriter<std::int32_t> row(root, "row", total);
  h5::ColumnWriter<std::int32_t> column(root, "column", total);
  h5::ColumnWriter<double> value(root, "form_factor", total);
  progress.begin("writing triplets", matrix.size());
  matrix.forPanels([&](const RowPanel& rows) {
    for (std::size_t i = rows.first(); i < rows.last(); ++i) {
      progress.check();
      std::ranges::fill(row.extend(entries[i]), std::int32_t(i));
      auto column_at = column.extend(entries[i]).begin();
      auto value_at = value.extend(entries[i]).begin();
      rows.forRow(i, [&](Index j, double factor) {
        *column_at++ = std::int32_t(j);
        *value_at++ = factor;
      });
      progress.advance();
    }
  });
  row.flush();
  column.flush();
  value.flush();
  progress.end();
}

void writeOfRows(h5::OutputGroup& root, const char* name, std::span<const double> values,
                 const char* unit) {
  root.dataset(name, {Number::f64, values.size(), 0}, values.data(), unit);
}

}  // namespace

void writeTripletsHdf5(const std::string& path, const NamedFactors& factors, Progress& progress) {
  AtomicFile target(path);
  h5::OutputFile file(target.temporary(), path);
  {
    h5::OutputGroup root(file);
    const auto n = std::int64_t(factors.size());
    const std::int64_t shape[2] = {n, n};
    root.attribute("shape", Number::i64, 2, shape);
    root.strings("names", factors.names);
    writeOfRows(root, "area", factors.matrix->area(), "m^2");
    writeOfRows(root, "sky", factors.sky, "");
    writeOfRows(root, "backs", factors.backs, "");
    if (!factors.error.empty()) writeOfRows(root, "error", factors.error, "");
    writeEntries(root, *factors.matrix, progress);
  }
  file.close();
  target.commit();
}

}  // namespace radiosity
