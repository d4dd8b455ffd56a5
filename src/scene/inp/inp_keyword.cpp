#include "scene/inp/inp_keyword.h"

#include <algorithm>
#include <array>
#include <vector>

#include "base/lower_case.h"
#include "base/parse.h"
#include "scene/text.h"

namespace radiosity {

namespace {

std::string_view unquoted(std::string_view text) {
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// The parts between commas that are not in quotation marks.
std::vector<std::string_view> partsOf(std::string_view line) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t k = 0; k <= line.size(); ++k) {
    if (k < line.size() && line[k] == '"') quoted = !quoted;
    if (k < line.size() && (line[k] != ',' || quoted)) continue;
    parts.push_back(line.substr(begin, k - begin));
    begin = k + 1;
  }
  return parts;
}

}  // namespace

std::vector<std::string_view> inpFields(std::string_view line) {
  std::vector<std::string_view> fields = partsOf(line);
  for (std::string_view& field : fields) field = unquoted(trimmed(field));
  if (fields.back().empty()) fields.pop_back();  // a comma at the end of the line
  return fields;
}

InpKeyword inpKeyword(std::string_view line) {
  const std::vector<std::string_view> parts = partsOf(line);
  InpKeyword keyword;
  keyword.word = lowerCase(trimmed(parts[0].substr(1)));
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const std::size_t equals = parts[k].find('=');
    const std::string name = lowerCase(trimmed(parts[k].substr(0, equals)));
    if (name.empty()) continue;
    std::string_view value;
    if (equals != std::string_view::npos) value = trimmed(parts[k].substr(equals + 1));
    keyword.parameters[name] = unquoted(value);
  }
  return keyword;
}

std::optional<ElementShape> inpFace(const std::string& type) {
  struct Family {
    ElementShape shape;
    std::vector<std::string_view> types;
  };
  static const std::array<Family, 5> kFamilies = {{
      {{2, 3, 3},
       {"s3", "s3r", "s3rs", "s3t", "s3rt", "stri3", "ds3", "m3d3", "r3d3", "sfm3d3", "cps3",
        "cpe3", "dc2d3"}},
      {{2, 3, 6}, {"s6", "stri65", "ds6", "m3d6", "sfm3d6", "cps6", "cpe6", "dc2d6"}},
      {{2, 4, 4},
       {"s4", "s4r", "s4rs", "s4rsw", "s4r5", "s4t", "s4rt", "ds4", "m3d4", "m3d4r", "r3d4",
        "sfm3d4", "sfm3d4r", "cps4", "cps4r", "cpe4", "cpe4r", "dc2d4"}},
      {{2, 4, 8},
       {"s8", "s8r", "s8r5", "s8rt", "ds8", "m3d8", "m3d8r", "sfm3d8", "sfm3d8r", "cps8", "cps8r",
        "cpe8", "cpe8r", "dc2d8"}},
      {{2, 4, 9}, {"s9r5", "m3d9", "m3d9r"}},
  }};
  for (const Family& family : kFamilies) {
    const auto& types = family.types;
    if (std::find(types.begin(), types.end(), type) != types.end()) return family.shape;
  }
  return std::nullopt;
}

std::optional<ElementShape> inpVolume(const std::string& type) {
  static constexpr std::array<ElementShape, 9> kShapes = {{{3, 4, 4},
                                                           {3, 5, 5},
                                                           {3, 6, 6},
                                                           {3, 8, 8},
                                                           {3, 4, 10},
                                                           {3, 5, 13},
                                                           {3, 6, 15},
                                                           {3, 8, 20},
                                                           {3, 8, 27}}};
  for (const std::string_view family : {"c3d", "dc3d", "dcc3d", "ac3d", "f3d", "fc3d", "q3d"}) {
    if (!type.starts_with(family)) continue;
    const std::size_t begin = family.size();
    std::size_t end = begin;
    while (end < type.size() && type[end] >= '0' && type[end] <= '9') ++end;
    const std::optional<long long> nodes =
        parseInteger(std::string_view(type).substr(begin, end - begin));
    for (const ElementShape& shape : kShapes) {
      if (nodes && *nodes == shape.nodes) return shape;
    }
  }
  return std::nullopt;
}

}  // namespace radiosity
