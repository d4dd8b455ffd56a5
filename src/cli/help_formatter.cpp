#include "cli/help_formatter.h"

#include <sstream>
#include <utility>

namespace radiosity::cli {

namespace {

constexpr std::size_t kNameColumn = 32;
constexpr std::size_t kLineWidth = 100;

/// "--symmetrize,--no-symmetrize{false}" -> "--symmetrize, --no-symmetrize".
std::string plainNames(const std::string& names) {
  std::string plain;
  bool in_braces = false;
  for (const char c : names) {
    in_braces = in_braces || c == '{';
    if (!in_braces) plain += c;
    if (c == ',' && !in_braces) plain += ' ';
    if (c == '}') in_braces = false;
  }
  return plain;
}

}  // namespace

HelpFormatter::HelpFormatter() { column_width(kNameColumn); }

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  // The base class writes an empty line both at the end of a group and at the start of the next.
  return CLI::detail::find_and_replace(CLI::Formatter::make_help(app, std::move(name), mode),
                                       "\n\n\n", "\n\n");
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  std::string left = "  " + plainNames(make_option_name(option, is_positional));
  if (!option->get_option_text().empty() && !is_positional) {
    left += " " + option->get_option_text();
  }
  std::string text = left;
  if (left.size() + 2 > kNameColumn) {
    text += "\n" + std::string(kNameColumn, ' ');
  } else {
    text += std::string(kNameColumn - left.size(), ' ');
  }
  std::istringstream words(make_option_desc(option));
  std::size_t at = kNameColumn;
  for (std::string word; words >> word;) {
    if (at > kNameColumn && at + 1 + word.size() > kLineWidth) {
      text += "\n" + std::string(kNameColumn, ' ');
      at = kNameColumn;
    } else if (at > kNameColumn) {
      text += ' ';
      ++at;
    }
    text += word;
    at += word.size();
  }
  return text + "\n";
}

}  // namespace radiosity::cli
