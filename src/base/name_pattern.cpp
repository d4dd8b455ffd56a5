#include "base/name_pattern.h"

#include <algorithm>
#include <optional>

namespace radiosity {

namespace {

bool continues(char byte) { return (static_cast<unsigned char>(byte) & 0xc0u) == 0x80u; }

/// Bytes of the character that `text`, which is not empty, begins with.
std::size_t firstLength(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t wanted = lead < 0xc0 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  if (wanted > text.size()) return 1;
  const std::string_view rest = text.substr(1, wanted - 1);
  return std::all_of(rest.begin(), rest.end(), continues) ? wanted : 1;
}

std::string_view takeFirst(std::string_view& text) {
  const std::string_view first = text.substr(0, firstLength(text));
  text.remove_prefix(first.size());
  return first;
}

/// Takes a character of a pattern, which may follow a backslash.
std::string_view takeLiteral(std::string_view& pattern) {
  if (pattern.size() > 1 && pattern.front() == '\\') pattern.remove_prefix(1);
  return takeFirst(pattern);
}

/// Takes "[abc]" from the pattern and says whether `character` is one of them; empty if the bracket
/// is not closed. The bytes of UTF-8 sort like the characters.
std::optional<bool> takeSet(std::string_view& pattern, std::string_view character) {
  std::string_view rest = pattern.substr(1);
  const bool negated = rest.starts_with('!') || rest.starts_with('^');
  if (negated) rest.remove_prefix(1);
  bool found = false;
  for (bool first = true; !rest.empty(); first = false) {
    if (rest.front() == ']' && !first) {
      pattern = rest.substr(1);
      return found != negated;
    }
    const std::string_view low = takeLiteral(rest);
    std::string_view high = low;
    if (rest.size() > 1 && rest[0] == '-' && rest[1] != ']') {
      rest.remove_prefix(1);
      high = takeLiteral(rest);
    }
    found = found || (low <= character && character <= high);
  }
  return std::nullopt;
}

/// Takes the item for one character from the pattern, which is not empty and does not begin with *,
/// and says whether `character` matches it.
bool takeOne(std::string_view& pattern, std::string_view character) {
  if (pattern.front() == '?') {
    pattern.remove_prefix(1);
    return true;
  }
  if (pattern.front() == '[') {
    if (const std::optional<bool> in_set = takeSet(pattern, character)) return *in_set;
  }
  return takeLiteral(pattern) == character;
}

}  // namespace

bool isPattern(std::string_view text) {
  return text.find_first_of("*?[") != std::string_view::npos;
}

// If a character does not fit, the last * takes one more; earlier ones need not be tried again.
bool matchesPattern(std::string_view pattern, std::string_view name) {
  std::optional<std::string_view> after_star;
  std::string_view from_star;  // the rest of the name after the part that the * takes
  while (true) {
    if (pattern.starts_with('*')) {
      pattern.remove_prefix(1);
      after_star = pattern;
      from_star = name;
      continue;
    }
    if (name.empty() && pattern.empty()) return true;
    if (!name.empty() && !pattern.empty() && takeOne(pattern, takeFirst(name))) continue;
    if (!after_star || from_star.empty()) return false;
    takeFirst(from_star);
    pattern = *after_star;
    name = from_star;
  }
}

}  // namespace radiosity
