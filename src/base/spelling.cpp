#include "radiosity/spelling.h"

#include "base/parse.h"

namespace radiosity {

namespace {

/// As in a call: what is no number is a text, but for one with quotes of its own.
std::string asKeyword(std::string_view field, std::string_view value) {
  std::string text(field);
  if (value.empty()) return text;
  const bool bare = parseNumber(value) || value.find('\'') != std::string_view::npos;
  const char* quote = bare ? "" : "'";
  return text.append("=").append(quote).append(value).append(quote);
}

Spelling spelling = asKeyword;

}  // namespace

std::string spelled(std::string_view field, std::string_view value) {
  return spelling(field, value);
}

void setSpelling(Spelling given) { spelling = given; }

}  // namespace radiosity
