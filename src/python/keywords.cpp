#include "keywords.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace radiosity::python {
namespace {

/// Options with another keyword, or followed by a value. The first that fits counts.
constexpr std::pair<std::string_view, std::string_view> kRenamed[] = {
    {"--set or", "set or"},
    {"--set ", "set: "},
    {"--one-sided ", "one_sided: "},
    {"--two-sided ", "two_sided: "},
    {"--flip ", "flip: "},
    {"--without ", "without: "},
    {"--group ", "groups: "},
    {"--condition ", "conditions: "},
    {"--thermal FILE", "table=FILE"},
    {"--solve-tolerance", "tolerance"},
    {"--heat-tolerance", "tolerance"},
    {"--gather-tolerance", "tolerance"},
    {"--near", "near_exact"},
    {"--emitters", "exact_emitters"}};

bool isLetter(char c) { return c >= 'a' && c <= 'z'; }

/// The place of the next option: "--" and a letter, at the start of a word.
std::size_t findOption(const std::string& text, std::size_t from) {
  for (std::size_t at = from; (at = text.find("--", at)) != std::string::npos; ++at) {
    const bool starts = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    if (starts && at + 2 < text.size() && isLetter(text[at + 2])) return at;
  }
  return std::string::npos;
}

/// Turns the option at `at` into a keyword: "--max-iterations" becomes max_iterations.
void dropDashes(std::string& text, std::size_t at) {
  text.erase(at, 2);
  for (; at < text.size() && (isLetter(text[at]) || text[at] == '-'); ++at) {
    if (text[at] == '-') text[at] = '_';
  }
}

}  // namespace

std::string withKeywords(std::string text) {
  for (std::size_t at = 0; (at = findOption(text, at)) != std::string::npos;) {
    const auto* known = std::ranges::find_if(kRenamed, [&](const auto& renamed) {
      return std::string_view(text).substr(at).starts_with(renamed.first);
    });
    if (known == std::ranges::end(kRenamed)) {
      dropDashes(text, at);
    } else {
      text.replace(at, known->first.size(), known->second);
    }
  }
  return text;
}

}  // namespace radiosity::python
