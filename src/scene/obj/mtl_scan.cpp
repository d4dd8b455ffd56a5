#include "scene/obj/mtl_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

#include "base/lower_case.h"
#include "base/parse.h"
#include "scene/obj/obj_scan.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Statements with numbers that do not matter for a diffuse material, or only if they differ from a
/// default (see MtlScanner::noteIgnored).
constexpr std::array<std::string_view, 17> kNumeric = {
    "Ka", "Ks", "Tf", "Ns", "Ni",  "d",     "Tr",     "illum", "sharpness",
    "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "Km"};

bool isMap(std::string_view keyword) {
  constexpr std::array<std::string_view, 5> kMaps = {"bump", "disp", "decal", "refl", "norm"};
  return keyword.starts_with("map_") ||
         std::find(kMaps.begin(), kMaps.end(), keyword) != kMaps.end();
}

/// The words after the keyword, up to a comment, without the option of `d -halo 0.5`.
std::vector<std::string_view> argumentsOf(const std::vector<std::string_view>& words) {
  const auto end = std::find_if(words.begin() + 1, words.end(),
                                [](std::string_view word) { return word[0] == '#'; });
  std::vector<std::string_view> arguments(words.begin() + 1, end);
  std::erase(arguments, "-halo");
  return arguments;
}

/// Removes the next word from a text and returns it.
std::string_view takeWord(std::string_view& text) {
  text = trimmed(text);
  const std::size_t end = std::min(text.find_first_of(kBlanks), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

/// Removes up to three numbers from a text; true if one of them is not `usual`.
bool takeNumbers(std::string_view& text, double usual) {
  bool differs = false;
  for (int k = 0; k < 3; ++k) {
    std::string_view rest = text;
    const std::optional<double> number = parseNumber(takeWord(rest));
    if (!number) break;
    differs = differs || *number != usual;
    text = rest;
  }
  return differs;
}

/// Parses options and the name of a file, which may contain blanks or have quotes around it.
MtlMap mapOf(std::string_view text) {
  constexpr std::array<std::string_view, 11> kOneWord = {
      "-blendu", "-blendv", "-boost", "-texres", "-bm",        "-imfchan",
      "-type",   "-cc",     "-halo",  "-uvset",  "-colorspace"};
  MtlMap map;
  text = trimmed(text);
  while (text.starts_with('-')) {
    std::string_view rest = text;
    const std::string option = lowerCase(takeWord(rest));
    if (option == "-s" || option == "-o" || option == "-t") {
      if (takeNumbers(rest, option == "-s" ? 1 : 0)) map.moved = true;
    } else if (option == "-clamp") {
      map.clamp = lowerCase(takeWord(rest)) == "on";
    } else if (option == "-mm") {
      takeWord(rest);
      takeWord(rest);
    } else if (std::find(kOneWord.begin(), kOneWord.end(), option) != kOneWord.end()) {
      takeWord(rest);
    } else {
      break;  // a name that begins with this character
    }
    text = rest;
  }
  const bool quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  map.file = quoted ? text.substr(1, text.size() - 2) : text;
  return map;
}

bool definesMaterial(std::string_view text) {
  bool any = false;
  forEachStatement(text, [&](std::size_t, std::string_view statement) {
    any = any || splitWords(statement)[0] == "newmtl";
  });
  return any;
}

class MtlScanner {
 public:
  MtlScanner(const std::string& file, FeatureNotes& ignored) : file_(file), ignored_(ignored) {}

  void statement(std::size_t line, std::string_view text);
  std::vector<MtlMaterial> finish() { return std::move(materials_); }

 private:
  std::string place() const { return fmt::format("{}:{}", file_, line_); }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", place(), what));
  }
  Vec3 colour(std::string_view keyword, const std::vector<std::string_view>& words) const;
  double value(std::string_view word, std::string_view keyword) const;
  std::vector<double> values(const std::vector<std::string_view>& words) const;
  void noteIgnored(std::string_view keyword, const std::vector<double>& values);

  const std::string& file_;
  FeatureNotes& ignored_;
  std::size_t line_ = 0;
  std::vector<MtlMaterial> materials_;
};

void MtlScanner::statement(std::size_t line, std::string_view text) {
  line_ = line;
  if (text[0] == '#') return;
  const std::vector<std::string_view> words = splitWords(text);
  const std::string_view keyword = words[0];
  if (keyword == "newmtl") {
    std::string name(trimmed(text.substr(keyword.size())));
    if (name.empty()) {
      name = kUnnamed;
      ignored_.add(fmt::format("newmtl names no material, it is called {}, line", kUnnamed),
                   std::to_string(line), Severity::warning);
    }
    materials_.push_back({.name = std::move(name), .line = line});
    return;
  }
  if (materials_.empty()) {
    ignored_.add("MTL statements before the first newmtl are not used",
                 fmt::format("`{}` in line {}", keyword, line), Severity::warning);
    return;
  }
  const std::string known = lowerCase(keyword);
  MtlMaterial& material = materials_.back();
  if (known == "kd") {
    const Vec3 given = colour(keyword, words);
    material.reflectance = settledReflectance(given, material.name, ignored_);
    if (!isReflectance(*material.reflectance)) material.out_of_range = place();
  } else if (known == "ke") {
    material.radiance = colour(keyword, words);
    if (!isEmission(*material.radiance)) material.out_of_range = place();
  } else if (known == "map_kd") {
    material.reflectance_map = mapOf(text.substr(keyword.size()));
  } else if (known == "map_ke") {
    material.radiance_map = mapOf(text.substr(keyword.size()));
  } else if (known == "map_d") {
    ignored_.add(maskFeature(), material.name, Severity::warning);
  } else if (isMap(keyword)) {
    ignored_.add(fmt::format("texture {} is not used, material", keyword), material.name);
  } else if (std::find(kNumeric.begin(), kNumeric.end(), keyword) != kNumeric.end()) {
    // Exporters write -nan(ind) for values that they do not use; we do not use them either.
    const auto arguments = argumentsOf(words);
    const auto bad = std::ranges::find_if_not(
        arguments, [](std::string_view word) { return parseNumber(word).has_value(); });
    if (bad == arguments.end()) return noteIgnored(keyword, values(words));
    ignored_.add("MTL statements that are not used have values that are no numbers",
                 fmt::format("`{}` in line {}", *bad, line));
  } else {
    ignored_.add(fmt::format("unknown MTL statement `{}` is not used, material", keyword),
                 material.name, Severity::warning);
  }
}

/// NaN for what exporters write for a number that is none, which --set may replace.
double MtlScanner::value(std::string_view word, std::string_view keyword) const {
  const std::optional<double> number = parseNumber(word);
  if (number) return *number;
  const std::string letters = lowerCase(word.substr(word.starts_with('-') ? 1 : 0));
  if (letters.starts_with("nan") || letters.starts_with("inf")) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  fail(fmt::format("material {}: `{}` is not a number; write {} with decimal points",
                   materials_.back().name, word, keyword));
}

std::vector<double> MtlScanner::values(const std::vector<std::string_view>& words) const {
  std::vector<double> result;
  for (const std::string_view word : argumentsOf(words)) result.push_back(value(word, words[0]));
  return result;
}

Vec3 MtlScanner::colour(std::string_view keyword,
                        const std::vector<std::string_view>& words) const {
  const std::vector<double> bands = values(words);
  // "If only r is specified, then g and b are assumed to be equal to r" (MTL specification).
  if (bands.size() == 1) return Vec3(bands[0]);
  if (bands.size() != 3) {
    fail(fmt::format("material {}: {} has {} numbers; give red, green and blue",
                     materials_.back().name, keyword, bands.size()));
  }
  return {bands[0], bands[1], bands[2]};
}

void MtlScanner::noteIgnored(std::string_view keyword, const std::vector<double>& values) {
  const auto any = [&](auto test) { return std::any_of(values.begin(), values.end(), test); };
  const std::string& name = materials_.back().name;
  if (keyword == "Ks" && any([](double v) { return v != 0; })) {
    ignored_.add("specular reflection (Ks) is not used, material", name);
  }
  const bool clear = (keyword == "d" && any([](double v) { return v < 1; })) ||
                     (keyword == "Tr" && any([](double v) { return v > 0; }));
  if (clear) ignored_.add(solidFeature(), name, Severity::warning);
  const std::pair<std::string_view, std::string_view> features[] = {
      {"Pr", "roughness (Pr)"},
      {"Pm", "metalness (Pm)"},
      {"Ps", "sheen (Ps)"},
      {"Pc", "clearcoat (Pc)"},
  };
  for (const auto& [statement, feature] : features) {
    if (keyword != statement || !any([](double v) { return v != 0; })) continue;
    ignored_.add(fmt::format("{} is not used, material", feature), name);
  }
  if (keyword == "Tf" && any([](double v) { return v != 0 && v != 1; })) {
    ignored_.add("transmission (Tf) is not used, material", name);
  }
}

}  // namespace

std::vector<MtlMaterial> scanMtl(const std::string& file, std::string_view text,
                                 FeatureNotes& ignored) {
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(file + ": is not a text file; export the materials as MTL");
  }
  if (!definesMaterial(text)) return {};
  MtlScanner scanner(file, ignored);
  forEachStatement(text, [&](std::size_t line, std::string_view s) { scanner.statement(line, s); });
  return scanner.finish();
}

}  // namespace radiosity
