// Pages for man(1), in the language of groff_man(7).
#include "cli/manuals.h"

#include <fmt/format.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "cli/help_formatter.h"
#include "radiosity/version.h"

namespace radiosity::cli {

namespace {

/// Text as it is to be read: no requests, no escapes, and minus signs that can be copied.
std::string troffText(const std::string& text) {
  std::string escaped;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) escaped += "\\&";
    escaped += c == '\\' ? "\\e" : c == '-' ? "\\-" : c == '\'' ? "\\(aq" : std::string(1, c);
    line_begins = c == '\n';
  }
  return escaped;
}

std::string troffOptions(const CLI::App& app) {
  std::string text;
  for (const std::string& group : app.get_groups()) {
    text += fmt::format(".SS {}\n", troffText(group));
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_group() != group || !option->nonpositional()) continue;
      text += fmt::format(".TP\n.B {}\n{}\n", troffText(namesAndValue(*option)),
                          troffText(option->get_description()));
    }
  }
  return text;
}

/// The text under the options: lines to be filled, then examples as they are.
std::string troffFooter(const std::string& footer) {
  const std::size_t examples = std::min(footer.find("Example"), footer.size());
  std::string text;
  if (examples > 0) text += ".SH NOTES\n" + troffText(footer.substr(0, examples)) + "\n";
  if (examples < footer.size()) {
    const std::size_t lines = footer.find('\n', examples) + 1;
    text += ".SH EXAMPLES\n.nf\n" + troffText(footer.substr(lines)) + "\n.fi\n";
  }
  return text;
}

/// `name`: "radiosity" or "radiosity-render".
std::string manualPage(const CLI::App& app, const std::string& name) {
  std::string page = fmt::format(
      ".TH {0} 1 \"\" \"radiosity {1}\" \"User Commands\"\n.SH NAME\n{0} \\- {2}\n.SH SYNOPSIS\n",
      troffText(name), RADIOSITY_VERSION,
      troffText(app.get_description().substr(0, app.get_description().find(". "))));
  std::string words = app.get_parent() == nullptr ? name : "radiosity " + app.get_name();
  std::string of_positions;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    words += " " + option->get_name(true, false);
    of_positions += fmt::format(".TP\n.I {}\n{}\n", option->get_name(true, false),
                                troffText(option->get_description()));
  }
  const auto subcommands = app.get_subcommands([](const CLI::App*) { return true; });
  if (!subcommands.empty()) words += " SUBCOMMAND";
  page += fmt::format(".B {}\n[OPTIONS]\n.SH DESCRIPTION\n{}\n{}", troffText(words),
                      troffText(app.get_description()), of_positions);
  std::string see = subcommands.empty() ? ".BR radiosity (1)\n" : "";
  for (const CLI::App* command : subcommands) {
    page +=
        fmt::format(".TP\n.B {}\n{}\n", command->get_name(), troffText(command->get_description()));
    see += fmt::format(".BR radiosity\\-{} (1){}\n", command->get_name(),
                       command == subcommands.back() ? "" : ",");
  }
  return page + ".SH OPTIONS\n" + troffOptions(app) + troffFooter(app.get_footer()) +
         ".SH SEE ALSO\n" + see;
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::error_code ignored;  // the file says what is wrong
  std::filesystem::create_directories(path.parent_path(), ignored);
  writeWholeFile(path, text);
}

}  // namespace

void writeManuals(const CLI::App& program, const std::string& folder) {
  const std::filesystem::path share = folder;
  writeText(share / "man/man1/radiosity.1", manualPage(program, "radiosity"));
  for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string name = "radiosity-" + command->get_name();
    writeText(share / "man/man1" / (name + ".1"), manualPage(*command, name));
  }
  writeText(share / "bash-completion/completions/radiosity", bashCompletion(program));
  writeText(share / "zsh/site-functions/_radiosity", zshCompletion(program));
  writeText(share / "fish/vendor_completions.d/radiosity.fish", fishCompletion(program));
}

}  // namespace radiosity::cli
