#include "base/parse.h"

#include <charconv>
#include <cmath>

namespace radiosity {

std::vector<std::string_view> splitAt(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    if (end == std::string_view::npos) {
      parts.push_back(text.substr(begin));
      return parts;
    }
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

std::optional<double> parseNumber(std::string_view word) {
  // Files may have a leading plus, which from_chars does not take; "+-1" must stay an error.
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = end == word.data() + word.size() && !word.empty();
  if (error != std::errc() || !whole || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<long long> parseInteger(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool whole = end == word.data() + word.size() && !word.empty();
  if (error != std::errc() || !whole) return std::nullopt;
  return value;
}

std::optional<Vec3> parseTriple(std::string_view text) {
  const std::vector<std::string_view> parts = splitAt(text, ',');
  if (parts.size() != 3) return std::nullopt;
  Vec3 result{0.0};
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> value = parseNumber(parts[std::size_t(k)]);
    if (!value) return std::nullopt;
    result[k] = *value;
  }
  return result;
}

}  // namespace radiosity
