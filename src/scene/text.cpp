#include "scene/text.h"

#include <fmt/format.h>

#include <algorithm>

namespace radiosity {

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string onOneLine(std::string_view text) {
  std::string line(trimmed(text));
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::replace(line.begin(), line.end(), '\r', ' ');
  return line;
}

std::vector<std::string_view> splitWords(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

std::string joinNames(std::span<const std::string> names, std::size_t limit) {
  std::string text;
  const std::size_t shown = std::min(names.size(), limit);
  for (std::size_t k = 0; k < shown; ++k) text += (k == 0 ? "" : ", ") + names[k];
  if (names.size() > shown) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string describeBands(const Vec3& value) {
  if (value.x == value.y && value.y == value.z) return fmt::format("{:.6g}", value.x);
  return fmt::format("{:.6g} {:.6g} {:.6g}", value.x, value.y, value.z);
}

}  // namespace radiosity
