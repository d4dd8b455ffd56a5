// Sparse rows as datasets of row, column and value.
#include "base/atomic_file.h"
#include "results/column_writer.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

using h5::Number;

void writeEntries(h5::OutputGroup& root, const ExchangeMatrix& matrix, Progress& progress) {
  const std::size_t entries = matrix.nonZeros();
  h5::ColumnWriter<std::int32_t> row(root, "row", entries);
  h5::ColumnWriter<std::int32_t> column(root, "column", entries);
  h5::ColumnWriter<double> value(root, "form_factor", entries);
  progress.begin("writing triplets", matrix.size());
  matrix.forPanels([&](const RowPanel& rows) {
    for (std::size_t i = rows.first(); i < rows.last(); ++i) {
      progress.check();
      rows.forRow(i, [&](Index j, double factor) {
        row.push(std::int32_t(i));
        column.push(std::int32_t(j));
        value.push(factor);
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
