#include "tables/table_rows.h"

#include <fmt/format.h>

#include <set>

#include "radiosity/spelling.h"

namespace radiosity {

void requireDistinctNames(const std::string& path, const NamedFactors& factors) {
  std::set<std::string> names;
  if (!factors.numbered) names.insert(factors.names.begin(), factors.names.end());
  if (names.contains(factors.sky_name) || factors.sky_name == "backs") {
    throw InputError(
        fmt::format("{}: the sky is called {}, as another receiver is; give it another name ({})",
                    path, factors.sky_name, spelled("sky_name")));
  }
  if (names.contains("backs")) {
    throw InputError(fmt::format(
        "{}: a surface is called backs, as the column of black backs is; rename it ({})", path,
        spelled("groups", "NAME=backs")));
  }
}

void requireTableSize(const std::string& path, const NamedFactors& factors) {
  if (!factors.numbered || factors.size() * factors.size() <= kMostTableValues) return;
  throw InputError(
      fmt::format("{}: a table of {} rows has {} values; write .mtx, .txt or .hdf5, or a table "
                  "between surfaces",
                  path, factors.size(), factors.size() * factors.size()));
}

void checkTableRows(const std::string& path, const NamedFactors& rows, TableLayout layout) {
  requireDistinctNames(path, rows);
  if (layout == TableLayout::wide) requireTableSize(path, rows);
}

void checkView3dRows(const std::string& path, const NamedFactors& rows) {
  requireTableSize(path, rows);
}

}  // namespace radiosity
