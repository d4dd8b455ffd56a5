#include "scene/mtl_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/parse.h"
#include "scene/obj_scan.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// Statements with numbers behind them that mean nothing to a diffuse material, or only where
/// they differ from a default (see MtlScanner::noteIgnored).
constexpr std::array<std::string_view, 17> kNumeric = {
    "Ka", "Ks", "Tf", "Ns", "Ni",  "d",     "Tr",     "illum", "sharpness",
    "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "Km"};

bool isMap(std::string_view keyword) {
  constexpr std::array<std::string_view, 5> kMaps = {"bump", "disp", "decal", "refl", "norm"};
  return keyword.starts_with("map_") ||
         std::find(kMaps.begin(), kMaps.end(), keyword) != kMaps.end();
}

class MtlScanner {
 public:
  MtlScanner(const std::string& file, FeatureNotes& ignored) : file_(file), ignored_(ignored) {}

  void statement(std::size_t line, std::string_view text);
  MtlScan finish() { return {std::move(materials_), std::move(text_)}; }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
  }
  Vec3 colour(std::string_view keyword, const std::vector<std::string_view>& words) const;
  std::vector<double> values(const std::vector<std::string_view>& words) const;
  void noteIgnored(std::string_view keyword, const std::vector<double>& values);

  const std::string& file_;
  FeatureNotes& ignored_;
  std::size_t line_ = 0;
  std::vector<MtlMaterial> materials_;
  std::string text_;
};

void MtlScanner::statement(std::size_t line, std::string_view text) {
  line_ = line;
  if (text[0] == '#') return;
  text_.append(text) += '\n';
  const std::vector<std::string_view> words = splitWords(text);
  const std::string_view keyword = words[0];
  if (keyword == "newmtl") {
    const std::string_view name = trimmed(text.substr(keyword.size()));
    if (name.empty()) fail("newmtl names no material; add the name");
    materials_.push_back({std::string(name), line, {}, {}, false, false});
    return;
  }
  if (materials_.empty()) {
    fail(fmt::format("`{}` stands before the first newmtl; name its material first", keyword));
  }
  MtlMaterial& material = materials_.back();
  if (keyword == "Kd") {
    material.reflectance = colour(keyword, words);
    checkReflectance(fmt::format("{}:{}", file_, line), material.name, *material.reflectance);
  } else if (keyword == "Ke") {
    material.radiance = colour(keyword, words);
    checkEmission(fmt::format("{}:{}", file_, line), material.name, *material.radiance);
  } else if (keyword == "map_Kd") {
    material.textured = true;
  } else if (keyword == "map_Ke") {
    material.glows = true;
  } else if (isMap(keyword)) {
    ignored_.add(fmt::format("texture {} is not used, material", keyword), material.name);
  } else if (std::find(kNumeric.begin(), kNumeric.end(), keyword) != kNumeric.end()) {
    noteIgnored(keyword, values(words));
  } else {
    ignored_.add(fmt::format("unknown MTL statement `{}` is not used, material", keyword),
                 material.name, Severity::warning);
  }
}

std::vector<double> MtlScanner::values(const std::vector<std::string_view>& words) const {
  std::vector<double> result;
  for (std::size_t k = 1; k < words.size() && words[k][0] != '#'; ++k) {
    if (words[k] == "-halo") continue;  // `d -halo 0.5`
    const std::optional<double> value = parseNumber(words[k]);
    if (!value) {
      fail(fmt::format("material {}: `{}` is not a finite number; write {} with decimal points",
                       materials_.back().name, words[k], words[0]));
    }
    result.push_back(*value);
  }
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
  if (clear) ignored_.add("transparency (d, Tr) is not used, material", name, Severity::warning);
  if (keyword == "Pm" && any([](double v) { return v != 0; })) {
    ignored_.add("metalness (Pm) is not used, material", name);
  }
  if (keyword == "Tf" && any([](double v) { return v != 0 && v != 1; })) {
    ignored_.add("transmission (Tf) is not used, material", name);
  }
}

}  // namespace

MtlScan scanMtl(const std::string& file, std::string_view text, FeatureNotes& ignored) {
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(file + ": is not a text file; export the materials as MTL");
  }
  MtlScanner scanner(file, ignored);
  forEachStatement(text, [&](std::size_t line, std::string_view s) { scanner.statement(line, s); });
  return scanner.finish();
}

}  // namespace radiosity
