// Reads reflectance, emission and areas of the rows of a matrix from tables.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/csv.h"
#include "base/input_file.h"
#include "base/near_names.h"
#include "base/parse.h"
#include "radiosity/matrix_files.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Stands for every row that no other line names.
constexpr const char* kOthers = "*";

/// The row of a line with a column `row`, from 0.
std::size_t rowOf(const CsvTable& table, const CsvTable::Row& line, std::size_t column,
                  std::size_t rows) {
  const std::string& text = line.fields[column];
  const std::optional<long long> value = parseInteger(text);
  if (value && *value >= 1 && std::size_t(*value) <= rows) return std::size_t(*value - 1);
  throw InputError(fmt::format("{}:{}: `{}` is no row: they go from 1 to {}", table.path, line.line,
                               text, rows));
}

class RowTable {
 public:
  RowTable(const CsvTable& table, const MatrixFile& matrix) : table_(table), matrix_(matrix) {
    row_ = table.column("row");
    name_ = table.column("name");
    if (row_.has_value() == name_.has_value()) {
      fail(1, "the header needs one of `row` (from 1) and `name`");
    }
    reflectance_ = bandsOf("reflectance");
    emission_ = bandsOf("emission");
    if (reflectance_.empty() && matrix.emissivity.empty()) {
      fail(1, "the header has no column `reflectance`, and the matrix no emissivities; add it");
    }
    requireKnownColumns();
    bands_ = std::max<std::size_t>(1, std::max(reflectance_.size(), emission_.size()));
    for (const auto* columns : {&reflectance_, &emission_}) {
      if (columns->empty() || columns->size() == bands_) continue;
      fail(1, fmt::format("there are {} columns of reflectance and {} of emission; give one a band",
                          reflectance_.size(), emission_.size()));
    }
  }

  PatchMaterials read() {
    const std::size_t n = matrix_.factors.size();
    line_of_.assign(n, 0);
    materials_.bands = int(bands_);
    materials_.reflectance.assign(n * bands_, 0.0);
    materials_.emission.assign(n * bands_, 0.0);
    for (const CsvTable::Row& row : table_.rows) {
      if (!isOfOthers(row)) take(row);
    }
    for (const CsvTable::Row& row : table_.rows) {
      if (isOfOthers(row)) takeOthers(row);
    }
    const auto missing = std::find(line_of_.begin(), line_of_.end(), 0u);
    if (missing != line_of_.end()) {
      const auto i = std::size_t(missing - line_of_.begin());
      throw InputError(
          fmt::format("{}: no line is for row {}{}; add one, or a line with {} {} "
                      "for all others",
                      table_.path, i + 1, nameText(i), name_ ? "name" : "row", kOthers));
    }
    return std::move(materials_);
  }

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", table_.path, line, what));
  }

  std::string nameText(std::size_t i) const {
    const std::string& name = matrix_.factors.names[i];
    return name.empty() ? "" : " (" + name + ")";
  }

  /// The columns NAME, or NAME_1, NAME_2, ...
  std::vector<std::size_t> bandsOf(const std::string& name) {
    std::vector<std::size_t> columns;
    const auto add = [&](const std::string& title) {
      const std::optional<std::size_t> found = table_.column(title);
      if (found) columns.push_back(*found);
      return found.has_value();
    };
    if (add(name)) return columns;
    for (std::size_t band = 1; add(fmt::format("{}_{}", name, band));) ++band;
    return columns;
  }

  void requireKnownColumns() const {
    std::set<std::size_t> known(reflectance_.begin(), reflectance_.end());
    known.insert(emission_.begin(), emission_.end());
    for (const auto& column : {row_, name_}) {
      if (column) known.insert(*column);
    }
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (known.contains(c)) continue;
      fail(1, fmt::format("column '{}' is none of row, name, reflectance, emission (of several "
                          "bands reflectance_1, ...)",
                          table_.header[c]));
    }
  }

  bool isOfOthers(const CsvTable::Row& row) const {
    return row.fields[name_.value_or(row_.value_or(0))] == kOthers;
  }

  double number(const CsvTable::Row& row, std::size_t column, double most) const {
    const std::string& text = row.fields[column];
    const std::optional<double> value = parseNumber(text);
    if (value && *value >= 0 && *value <= most) return *value;
    fail(row.line,
         fmt::format("{} `{}` is not {}", table_.header[column], text,
                     most <= 1 ? "a number within 0 and 1" : "a finite number, 0 or more (W/m^2)"));
  }

  void set(const CsvTable::Row& row, std::size_t i) {
    if (line_of_[i] != 0) {
      fail(row.line,
           fmt::format("row {} is given on line {} already; give it once", i + 1, line_of_[i]));
    }
    line_of_[i] = row.line;
    for (std::size_t b = 0; b < bands_; ++b) {
      const std::size_t at = i * bands_ + b;
      materials_.reflectance[at] =
          reflectance_.empty() ? 1 - matrix_.emissivity[i] : number(row, reflectance_[b], 1);
      if (!emission_.empty()) materials_.emission[at] = number(row, emission_[b], 1e300);
    }
  }

  void take(const CsvTable::Row& row) {
    const std::size_t n = matrix_.factors.size();
    if (!name_) {
      return set(row, rowOf(table_, row, row_.value_or(0), n));
    }
    const std::string& name = row.fields[*name_];
    bool any = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (matrix_.factors.names[i] != name) continue;
      any = true;
      set(row, i);
    }
    if (!any) failForName(row.line, name);
  }

  [[noreturn]] void failForName(std::size_t line, const std::string& name) const {
    std::set<std::string> seen(matrix_.factors.names.begin(), matrix_.factors.names.end());
    seen.erase("");
    const std::vector<std::string> names(seen.begin(), seen.end());
    fail(line, names.empty() ? fmt::format("{} has no names; use a column `row`", matrix_.path)
                             : fmt::format("no row is called {}; there are: {}", name,
                                           joinNames(nearestFirst(name, names), 40)));
  }

  void takeOthers(const CsvTable::Row& row) {
    for (std::size_t i = 0; i < line_of_.size(); ++i) {
      if (line_of_[i] == 0) set(row, i);
    }
  }

  const CsvTable& table_;
  const MatrixFile& matrix_;
  std::optional<std::size_t> row_;
  std::optional<std::size_t> name_;
  std::vector<std::size_t> reflectance_;
  std::vector<std::size_t> emission_;
  std::size_t bands_ = 1;
  std::vector<std::size_t> line_of_;  ///< by row; 0: none yet
  PatchMaterials materials_;
};

double areaIn(const std::string& path, std::size_t line, std::string_view text) {
  const std::optional<double> value = parseNumber(text);
  if (value && *value >= 0) return *value;
  throw InputError(
      fmt::format("{}:{}: `{}` is no area: a finite number, 0 or more (m^2)", path, line, text));
}

/// The areas of a table whose lines have the rows' numbers: in any order, each once.
std::vector<double> areasByRow(const CsvTable& table, std::size_t area) {
  const std::size_t row = table.column("row").value_or(0);
  std::vector<double> areas(table.rows.size());
  std::vector<std::size_t> line_of(table.rows.size(), 0);
  for (const CsvTable::Row& line : table.rows) {
    const std::size_t i = rowOf(table, line, row, areas.size());
    if (line_of[i] != 0) {
      throw InputError(fmt::format("{}:{}: row {} is given on line {} already; give it once",
                                   table.path, line.line, i + 1, line_of[i]));
    }
    line_of[i] = line.line;
    areas[i] = areaIn(table.path, line.line, line.fields[area]);
  }
  return areas;
}

}  // namespace

PatchMaterials readRowMaterials(const std::string& path, const MatrixFile& matrix) {
  const CsvTable table = readCsv(path);
  return RowTable(table, matrix).read();
}

std::vector<double> readAreas(const std::string& path) {
  const CsvTable table = readCsv(path);
  const std::optional<std::size_t> named = table.column("area_m2");
  if (named && table.column("row")) return areasByRow(table, *named);
  std::vector<double> areas;
  areas.reserve(table.rows.size() + 1);
  // Without a header, the first number is in its place.
  if (!named && table.header.size() > 1) {
    throw InputError(path + ": has no column area_m2; name it so, or give one number a line");
  }
  if (!named) areas.push_back(areaIn(path, 1, table.header.front()));
  for (const CsvTable::Row& row : table.rows) {
    areas.push_back(areaIn(path, row.line, row.fields[named.value_or(0)]));
  }
  return areas;
}

}  // namespace radiosity
