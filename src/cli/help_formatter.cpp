#include "cli/help_formatter.h"

#include <sstream>
#include <utility>

namespace radiosity::cli {

namespace {

constexpr std::size_t kNameColumn = 32;
constexpr std::size_t kLineWidth = 100;

/// `text`, its words broken into lines that begin in column `indent`, where the first one is
/// already.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string lines;
  std::size_t at = indent;
  for (std::string word; words >> word;) {
    if (at > indent && at + 1 + word.size() > kLineWidth) {
      lines += "\n" + std::string(indent, ' ');
      at = indent;
    } else if (at > indent) {
      lines += ' ';
      ++at;
    }
    lines += word;
    at += word.size();
  }
  return lines;
}

}  // namespace

std::string namesAndValue(const CLI::Option& option) {
  std::string text;
  bool in_braces = false;  // "--symmetrize,--no-symmetrize{false}"
  for (const char c : option.get_name(false, true)) {
    in_braces = in_braces || c == '{';
    if (!in_braces) text += c;
    if (c == ',' && !in_braces) text += ' ';
    if (c == '}') in_braces = false;
  }
  if (!option.get_option_text().empty()) text += " " + option.get_option_text();
  return text;
}

HelpFormatter::HelpFormatter() { column_width(kNameColumn); }

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode mode) const {
  if (mode == CLI::AppFormatMode::Normal && app->get_parent() != nullptr) {
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) +
           namesInGroups(*app) + "\n" + make_footer(app);
  }
  // The base class writes an empty line both at the end of a group and at the start of the next.
  return CLI::detail::find_and_replace(
      CLI::Formatter::make_help(app, std::move(name), CLI::AppFormatMode::Normal), "\n\n\n",
      "\n\n");
}

std::string HelpFormatter::namesInGroups(const CLI::App& app) const {
  std::string text;
  for (const std::string& group : app.get_groups()) {
    const std::vector<const CLI::Option*> options = app.get_options([&](const CLI::Option* option) {
      return option->nonpositional() && option->get_group() == group;
    });
    if (group == app.get_help_ptr()->get_group()) {
      text += make_group(group, false, options);
      continue;
    }
    std::string names;
    for (const CLI::Option* option : options) {
      const std::string& value = option->get_option_text();
      names += option->get_name() + (value.empty() ? "" : " " + value) +
               (option == options.back() ? "" : ", ");
    }
    text += "\n" + group + ":\n  " + wrapped(names, 2) + "\n";
  }
  return text;
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  const std::string left =
      "  " + (is_positional ? option->get_name(true, false) : namesAndValue(*option));
  const bool below = left.size() + 2 > kNameColumn;
  return left +
         (below ? "\n" + std::string(kNameColumn, ' ')
                : std::string(kNameColumn - left.size(), ' ')) +
         wrapped(make_option_desc(option), kNameColumn) + "\n";
}

}  // namespace radiosity::cli
