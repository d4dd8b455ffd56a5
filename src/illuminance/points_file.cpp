// Points from a table.
#include <fmt/format.h>

#include <array>
#include <glm/geometric.hpp>

#include "base/csv.h"
#include "base/figure_text.h"
#include "base/input_file.h"
#include "base/parse.h"
#include "illuminance/directions.h"

namespace radiosity {
namespace {

constexpr std::array kPointColumns = {"x", "y", "z", "nx", "ny", "nz"};

/// The places of the columns; those of normals may be missing, all or none.
struct PointColumns {
  std::array<std::size_t, kPointColumns.size()> at{};
  bool normals = false;
};

PointColumns columnsOf(const CsvTable& table) {
  const auto fail = [&](const std::string& what) {
    throw InputError(fmt::format(
        "{}:{}: {}; the columns are x, y, z (metres) and, where points do not face up, nx, ny, nz",
        table.path, table.header_line, what));
  };
  PointColumns columns;
  std::size_t normals = 0;
  for (std::size_t k = 0; k < kPointColumns.size(); ++k) {
    const std::string name = kPointColumns[k];
    std::optional<std::size_t> found = table.column(name);
    if (!found) found = table.column(name + "_m");
    if (!found && k < 3) fail(fmt::format("there is no column {}", name));
    if (found && k >= 3) ++normals;
    columns.at[k] = found.value_or(0);
  }
  if (normals == 1 || normals == 2) fail("nx, ny and nz are not all there");
  columns.normals = normals == 3;
  return columns;
}

Vec3 vectorIn(const CsvTable& table, const CsvTable::Row& row, const PointColumns& columns,
              std::size_t first) {
  Vec3 vector(0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string& field = row.fields[columns.at[first + k]];
    const std::optional<double> number = parseNumber(field);
    if (!number) {
      throw InputError(fmt::format("{}:{}: `{}` in column {} is no finite number", table.path,
                                   row.line, field, kPointColumns[first + k]));
    }
    vector[int(k)] = *number;
  }
  return vector;
}

}  // namespace

MeasuringPoints readMeasuringPoints(const std::string& path, Up up) {
  const CsvTable table = parseCsv(path, readWholeFile(path), kPointColumns);
  const PointColumns columns = columnsOf(table);
  if (table.rows.empty()) throw InputError(path + ": there are no points below the header");
  if (table.rows.size() > kMostGridPoints) {
    throw InputError(fmt::format("{}: has {} points; at most {} are evaluated", path,
                                 countText(table.rows.size()), countText(kMostGridPoints)));
  }
  MeasuringPoints out;
  out.name = path;
  for (const CsvTable::Row& row : table.rows) {
    out.at.push_back(vectorIn(table, row, columns, 0));
    const Vec3 normal = columns.normals ? vectorIn(table, row, columns, 3) : upVector(up);
    if (!(glm::length(normal) > 0)) {
      throw InputError(
          fmt::format("{}:{}: the normal is 0,0,0, which faces nowhere", path, row.line));
    }
    out.normal.push_back(glm::normalize(normal));
  }
  return out;
}

}  // namespace radiosity
