// Sources of light from a table: each set lists the surfaces that shine together.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/csv.h"
#include "base/parse.h"
#include "radiosity/light_basis.h"
#include "scene/surface_names.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// The most names that a message lists.
constexpr std::size_t kMostNames = 40;

[[noreturn]] void fail(const CsvTable& table, std::size_t line, const std::string& what) {
  throw InputError(fmt::format("{}:{}: {}", table.path, line, what));
}

struct Columns {
  std::size_t set = 0;
  std::size_t name = 0;
  std::vector<std::size_t> emission;  ///< one, or red, green and blue
};

Columns columnsOf(const CsvTable& table, int bands) {
  const std::optional<std::size_t> set = table.column("set");
  const std::optional<std::size_t> name = table.column("name");
  const std::optional<std::size_t> grey = table.column("emission");
  std::vector<std::size_t> colours;
  for (const char* colour : {"r", "g", "b"}) {
    if (const auto column = table.column(colour)) colours.push_back(*column);
  }
  const std::vector<std::size_t> emission = grey ? std::vector{*grey} : colours;
  const bool whole = emission.size() == (grey ? 1 : 3);
  if (!set || !name || !whole || table.header.size() != 2 + emission.size()) {
    fail(table, table.header_line,
         fmt::format("the columns are {}; there must be set,name,emission or set,name,r,g,b",
                     fmt::join(table.header, ",")));
  }
  if (!grey && bands != 3) {
    fail(table, table.header_line,
         fmt::format("r,g,b are three bands and the materials have {}; give one column, emission",
                     bands));
  }
  return {*set, *name, emission};
}

std::vector<double> emissionOf(const CsvTable& table, const CsvTable::Row& row,
                               const Columns& columns, int bands) {
  std::vector<double> emission;
  for (const std::size_t column : columns.emission) {
    const std::string& text = row.fields[column];
    const std::optional<double> value = parseNumber(trimmed(text));
    if (!value || *value < 0) {
      fail(table, row.line,
           fmt::format("{} `{}` is not a finite number >= 0 (W/m^2)", table.header[column], text));
    }
    emission.push_back(*value);
  }
  if (emission.size() == 1) emission.assign(std::size_t(bands), emission[0]);
  return emission;
}

/// A source while its lines are read.
struct Set {
  LightSource source;
  std::vector<bool> has;  ///< S: surfaces that a line named
};

Set& setNamed(std::vector<Set>& sets, const std::string& name, const Scene& scene,
              std::size_t emissions) {
  const auto found =
      std::ranges::find_if(sets, [&](const Set& set) { return set.source.name == name; });
  if (found != sets.end()) return *found;
  return sets.emplace_back(
      Set{{name, std::vector<double>(emissions), {}}, std::vector<bool>(scene.surfaces.size())});
}

}  // namespace

std::vector<LightSource> readLightSources(const std::string& csv_path, const Scene& scene,
                                          const PatchMesh& mesh, int bands) {
  const CsvTable table = readCsv(csv_path);
  const Columns columns = columnsOf(table, bands);
  const auto width = std::size_t(bands);
  std::vector<Set> sets;
  for (const CsvTable::Row& row : table.rows) {
    const std::string set_name(trimmed(row.fields[columns.set]));
    const std::string name(trimmed(row.fields[columns.name]));
    if (set_name.empty()) fail(table, row.line, "the set has no name");
    const std::vector<double> emission = emissionOf(table, row, columns, bands);
    const std::vector<Index> surfaces = surfacesNamed(scene, name);
    if (surfaces.empty()) {
      fail(table, row.line,
           fmt::format("nothing is called '{}'; there are {}", name,
                       joinNames(knownNames(scene), kMostNames)));
    }
    Set& set = setNamed(sets, set_name, scene, width * mesh.size());
    for (const Index surface : surfaces) {
      if (set.has[surface]) {
        fail(table, row.line,
             fmt::format("surface '{}' is in the set '{}' twice", scene.surfaces[surface].name,
                         set_name));
      }
      set.has[surface] = true;
    }
    for (std::size_t i = 0; i < mesh.size(); ++i) {
      if (!std::ranges::binary_search(surfaces, mesh.surface[i])) continue;
      std::ranges::copy(emission, set.source.emission.begin() + std::ptrdiff_t(i * width));
    }
  }
  if (sets.empty()) fail(table, table.header_line, "no line follows the header: there are no sets");
  std::vector<LightSource> sources;
  sources.reserve(sets.size());
  for (Set& set : sets) sources.push_back(std::move(set.source));
  return sources;
}

}  // namespace radiosity
