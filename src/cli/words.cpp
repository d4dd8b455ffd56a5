#include "cli/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "base/figure_text.h"
#include "base/near_names.h"
#include "base/option_list.h"
#include "base/printable.h"
#include "radiosity/base.h"
#include "radiosity/form_factors.h"
#include "radiosity/names.h"

namespace radiosity::cli {

std::string durationText(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.2f} s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string numberText(double value, int digits) {
  return std::isnan(value) ? "none" : fmt::format("{:.{}g}", value, digits);
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
  return countText(count) + " " + (count == 1 ? one : many);
}

std::vector<std::string> bandNames(int bands) {
  if (bands == 3) return {"R", "G", "B"};
  std::vector<std::string> names;
  for (int b = 1; b <= bands; ++b) names.push_back(fmt::format("band {}", b));
  return names;
}

std::string bandsText(int bands) {
  if (bands == 3) return "R G B";
  return bands == 1 ? "band 1" : fmt::format("bands 1 to {}", bands);
}

namespace {

/// A number and the text after it; NaN and the whole text if there is no number.
std::pair<double, std::string> numberAndUnit(const std::string& text) {
  double value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc()) return {std::numeric_limits<double>::quiet_NaN(), text};
  return {value, std::string(end, last)};
}

}  // namespace

std::size_t parseBytes(const std::string& option, const std::string& text) {
  auto [value, unit] = numberAndUnit(text);
  std::transform(unit.begin(), unit.end(), unit.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  constexpr const char* kForms[][4] = {{"", "B", "B", "B"},
                                       {"K", "KB", "KIB", "K"},
                                       {"M", "MB", "MIB", "M"},
                                       {"G", "GB", "GIB", "G"},
                                       {"T", "TB", "TIB", "T"}};
  for (std::size_t power = 0; power < std::size(kForms); ++power) {
    if (std::find(std::begin(kForms[power]), std::end(kForms[power]), unit) ==
        std::end(kForms[power])) {
      continue;
    }
    const double bytes = std::ldexp(value, int(10 * power));
    if (bytes >= 1 && bytes < 0x1p63) return std::size_t(bytes);
  }
  throw InputError(fmt::format(
      "{}: '{}' is not a size above 0; write bytes or a number with K, M, G or T, e.g. 512M or 2G",
      option, text));
}

double parseDuration(const std::string& option, const std::string& text) {
  constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
      {{"", 1}, {"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}}};
  const auto [value, rest] = numberAndUnit(text);
  for (const auto& [unit, seconds] : kUnits) {
    if (rest == unit && value > 0 && std::isfinite(value)) return value * seconds;
  }
  throw InputError(fmt::format(
      "{}: '{}' is not a time above 0; write seconds or a number with s, m or h, e.g. 90s or 10m",
      option, text));
}

std::optional<std::string> nearest(const std::string& word,
                                   std::span<const std::string> candidates) {
  // One letter in four may differ, so that --symmetry is not taken for --symmetrize, which is
  // another thing. What is only begun, as rend, is taken for the only word that begins so.
  const std::size_t letters = word.size() - std::min(word.size(), word.find_first_not_of('-'));
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(1, letters / 4) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = editDistance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  if (best || letters < 2) return best;
  for (const std::string& candidate : candidates) {
    if (!candidate.starts_with(word)) continue;
    if (best) return std::nullopt;
    best = candidate;
  }
  return best;
}

std::string suggestion(const std::string& word, std::span<const std::string> candidates) {
  const std::optional<std::string> meant = nearest(word, candidates);
  return meant ? fmt::format("; did you mean {}?", *meant) : std::string();
}

namespace {

/// The longest line. A file may have a word of megabytes; its beginning and end identify it.
constexpr std::size_t kLongestLine = 2000;

std::string shortened(const std::string& text) {
  if (text.size() <= kLongestLine) return text;
  const auto boundary = [&](std::size_t k) {
    while (k > 0 && (static_cast<unsigned char>(text[k]) & 0xc0u) == 0x80u) --k;
    return k;
  };
  const std::size_t head = boundary(kLongestLine / 2);
  const std::size_t tail = boundary(text.size() - kLongestLine / 2);
  return fmt::format("{} [{} left out] {}", text.substr(0, head), bytesText(tail - head),
                     text.substr(tail));
}

}  // namespace

std::string spelledAsOption(std::string_view field, std::string_view value) {
  // Of options that no struct lists.
  constexpr std::pair<std::string_view, const char*> kNames[] = {
      {"groups", "group"}, {"conditions", "condition"}, {"table", "thermal"}};
  const std::string name(field);
  OptionLine line{.name = name.c_str()};
  for (const auto& [known, option] : kNames) {
    if (field == known) line.option = option;
  }
  const auto look = [&](const std::vector<Option>& options) {
    for (const Option& option : options) {
      if (field == option.line.name) line.option = option.line.option;
    }
  };
  look(optionLines(SceneOptions()));
  look(optionLines(SceneOverrides()));
  look(optionLines(FormFactorOptions()));
  return fmt::format("--{}{}{}", line.optionName(), value.empty() ? "" : " ", value);
}

std::string shellWord(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                          "0123456789_./:=,+-@%") == std::string::npos;
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string oneLine(const std::string& text) {
  std::string line;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] == '\r' && k + 1 < text.size() && text[k + 1] == '\n') continue;
    if (text[k] != '\n') {
      line += text[k];
    } else if (!line.empty() && k + 1 < text.size()) {
      line += "; ";
    }
  }
  return printable(shortened(line));
}

}  // namespace radiosity::cli
