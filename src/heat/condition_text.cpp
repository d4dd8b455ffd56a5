#include "heat/condition_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/csv.h"
#include "base/parse.h"
#include "heat/conditions.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// An emissivity that is 1 - reflectance of the surface's material.
constexpr std::string_view kOfMaterial = "material";

[[noreturn]] void fail(const std::string& origin, const std::string& what) {
  throw InputError(fmt::format("{}: {}", origin, what));
}

double numberIn(const std::string& origin, const char* what, std::string_view text) {
  const std::optional<double> value = parseNumber(text);
  if (!value) fail(origin, fmt::format("{} `{}` is not a finite number", what, text));
  return *value;
}

double atLeast0(const std::string& origin, const char* what, std::string_view text) {
  const double value = numberIn(origin, what, text);
  if (value < 0) fail(origin, fmt::format("{} {} is below 0", what, text));
  return value;
}

double kelvin(const std::string& origin, const char* what, std::string_view text) {
  const double value = numberIn(origin, what, text);
  if (value < 0)
    fail(origin, fmt::format("{} {} is below 0; temperatures are in kelvin", what, text));
  if (value > kHottest)
    fail(origin, fmt::format("{} {} is above {:g} K, which no surface has", what, text, kHottest));
  return value;
}

double emissivityValue(const std::string& origin, std::string_view text) {
  const double value = numberIn(origin, "emissivity", text);
  if (!(value >= 0 && value <= 1)) {
    fail(origin, fmt::format("emissivity {} is not within 0 and 1", text));
  }
  return value;
}

[[noreturn]] void failForForm(const std::string& origin, std::string_view text) {
  fail(origin, fmt::format("emissivity `{}` is neither one number nor a table like 300:0.1 "
                           "800:0.25 (kelvin:emissivity), nor the word material",
                           text));
}

/// "0.8", or a table "300:0.1 800:0.25".
Emissivity parseEmissivity(const std::string& origin, std::string_view text) {
  Emissivity emissivity;
  for (const std::string_view word : splitWords(text)) {
    const std::size_t colon = word.find(':');
    if (colon == std::string_view::npos) {
      if (splitWords(text).size() != 1 || !parseNumber(word)) failForForm(origin, text);
      emissivity.values = {emissivityValue(origin, word)};
      return emissivity;
    }
    const double t = kelvin(origin, "temperature of an emissivity", word.substr(0, colon));
    if (!emissivity.temperatures.empty() && !(t > emissivity.temperatures.back())) {
      fail(origin, fmt::format("temperatures of emissivity `{}` do not increase", text));
    }
    emissivity.temperatures.push_back(t);
    emissivity.values.push_back(emissivityValue(origin, word.substr(colon + 1)));
  }
  if (emissivity.values.empty()) {
    fail(origin, "a band has no emissivity; write one a band, 0.8; 0.3");
  }
  return emissivity;
}

void setEmissivity(GivenCondition& given, std::string_view text) {
  if (text == kOfMaterial) {
    given.emissivity_of_material = true;
    return;
  }
  std::vector<Emissivity>& bands = given.emissivity.emplace();
  for (const std::string_view band : splitAt(text, ';')) {
    bands.push_back(parseEmissivity(given.origin, trimmed(band)));
  }
}

bool parseYes(const std::string& origin, std::string_view text) {
  if (text == "yes") return true;
  if (text != "no") fail(origin, fmt::format("isothermal `{}` is neither yes nor no", text));
  return false;
}

struct Property {
  const char* name;    ///< in a setting
  const char* column;  ///< in a table, with its unit
  void (*set)(GivenCondition& given, std::string_view text);
};

constexpr const char* kNameColumn = "surface";

constexpr std::array<Property, 7> kProperties = {{
    {"emissivity", "emissivity", setEmissivity},
    {"temperature", "temperature_K",
     [](GivenCondition& g, std::string_view t) {
       g.temperature = kelvin(g.origin, "temperature", t);
     }},
    {"flux", "flux_W_per_m2",
     [](GivenCondition& g, std::string_view t) { g.flux = numberIn(g.origin, "flux", t); }},
    {"power", "power_W",
     [](GivenCondition& g, std::string_view t) { g.power = numberIn(g.origin, "power", t); }},
    {"convection", "convection_W_per_m2_K",
     [](GivenCondition& g, std::string_view t) {
       g.convection = atLeast0(g.origin, "convection", t);
     }},
    {"ambient", "ambient_K",
     [](GivenCondition& g, std::string_view t) { g.ambient = kelvin(g.origin, "ambient", t); }},
    {"isothermal", "isothermal",
     [](GivenCondition& g, std::string_view t) { g.isothermal = parseYes(g.origin, t); }},
}};

std::string listOf(const char* Property::*name) {
  std::string list;
  for (const Property& property : kProperties) {
    list += (list.empty() ? "" : ", ") + std::string(property.*name);
  }
  return list;
}

/// The property of each column; null for that of names.
std::vector<const Property*> columnsOf(const std::vector<std::string>& header,
                                       const std::string& origin) {
  std::vector<const Property*> columns;
  for (const std::string& title : header) {
    if (title == kNameColumn) {
      columns.push_back(nullptr);
      continue;
    }
    const auto found = std::ranges::find_if(
        kProperties, [&](const Property& property) { return title == property.column; });
    if (found == kProperties.end()) {
      fail(origin,
           fmt::format("column `{}` is unknown; there are, with commas between them: {}, {}", title,
                       kNameColumn, listOf(&Property::column)));
    }
    columns.push_back(found);
  }
  if (std::ranges::count(columns, nullptr) == 0) {
    fail(origin, fmt::format("the header names no column `{}`", kNameColumn));
  }
  return columns;
}

void checkHeated(const GivenCondition& given) {
  if (int(given.temperature.has_value()) + int(given.flux.has_value()) +
          int(given.power.has_value()) >
      1) {
    fail(given.origin,
         fmt::format("{}: more than one of temperature, flux and power; give one", given.name));
  }
}

GivenCondition parseRow(const std::vector<std::string>& cells,
                        const std::vector<const Property*>& columns, const std::string& origin) {
  GivenCondition given;
  given.origin = origin;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (columns[c] == nullptr) given.name = cells[c];
  }
  if (given.name.empty()) {
    fail(origin, "names no surface; write * for all that are not named");
  }
  given.origin = fmt::format("{}: {}", origin, given.name);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (columns[c] != nullptr && !cells[c].empty()) columns[c]->set(given, cells[c]);
  }
  given.origin = origin;
  checkHeated(given);
  return given;
}

}  // namespace

std::vector<GivenCondition> parseConditionTable(const std::string& origin, std::string_view text) {
  const CsvTable table = parseCsv(origin, text);
  const std::vector<const Property*> columns =
      columnsOf(table.header, fmt::format("{}:{}", origin, table.header_line));
  std::vector<GivenCondition> rows;
  rows.reserve(table.rows.size());
  for (const CsvTable::Row& row : table.rows) {
    rows.push_back(parseRow(row.fields, columns, fmt::format("{}:{}", origin, row.line)));
  }
  if (rows.empty()) {
    throw InputError(
        fmt::format("{}: holds no conditions; write a header, {},{}, and a line a surface", origin,
                    kNameColumn, "emissivity,temperature_K"));
  }
  return rows;
}

GivenCondition parseSetting(const std::string& text) {
  GivenCondition given;
  given.origin = spelled("conditions", text);
  // Names may contain dots and equals signs: the value begins after the last '=', the property
  // after the last '.' before it.
  const std::size_t equals = text.rfind('=');
  const std::size_t dot = equals == std::string::npos ? equals : text.rfind('.', equals);
  if (dot == std::string::npos || dot == 0) {
    fail(given.origin, "is not NAME.PROPERTY=VALUE, for example lamp.temperature=500");
  }
  given.name = text.substr(0, dot);
  const std::string property(trimmed(text.substr(dot + 1, equals - dot - 1)));
  const auto found = std::ranges::find_if(
      kProperties, [&](const Property& candidate) { return property == candidate.name; });
  if (found == kProperties.end()) {
    fail(given.origin, fmt::format("`{}` is none of {}", property, listOf(&Property::name)));
  }
  found->set(given, trimmed(std::string_view(text).substr(equals + 1)));
  return given;
}

}  // namespace radiosity
