// Completions for bash, zsh and fish: subcommands, options, words that options take; else files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/manuals.h"

namespace radiosity::cli {

namespace {

/// The options of a subcommand, or of the program before one, without those of positions.
std::vector<const CLI::Option*> namedOptions(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

/// "-o", "--output", "--no-resume".
std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takesValue(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// The words that it takes, of CLI11's "TEXT:{on,off}"; none: anything.
std::vector<std::string> wordsOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  const std::size_t end = type.find('}');
  if (begin == std::string::npos || end == std::string::npos) return {};
  return CLI::detail::split(type.substr(begin + 1, end - begin - 1), ',');
}

/// What stands before the first break of a help text, for one line of a menu, without quotes.
std::string inShort(const std::string& text) {
  std::size_t end = text.size();
  for (const char* sign : {". ", "; ", ": ", " ("}) end = std::min(end, text.find(sign));
  std::string line = text.substr(0, end);
  std::erase_if(line, [](char c) { return c == '\'' || c == '[' || c == ']' || c == '\\'; });
  std::replace(line.begin(), line.end(), ':', ',');
  return line;
}

std::vector<const CLI::App*> subcommands(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

constexpr const char* kBash = R"(# bash completion of radiosity
_radiosity() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} words=
  [[ $word == = ]] && word=
  [[ $before == = ]] && before=${{COMP_WORDS[COMP_CWORD-2]}}
  if ((COMP_CWORD == 1)); then
    words='{}'
  elif [[ $word == -* ]]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  else
    case ${{COMP_WORDS[1]}}:$before in
{}    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}}
complete -o default -F _radiosity radiosity
)";

constexpr const char* kZsh = R"(#compdef radiosity
local context state line
typeset -A opt_args
_arguments -C {}'1:subcommand:->subcommand' '*::argument:->argument'
case $state in
  subcommand)
    local -a subcommands=({})
    _describe subcommand subcommands
    ;;
  argument)
    case $words[1] in
{}    esac
    ;;
esac
)";

/// An option as zsh's _arguments takes it: '*--unit=[Unit of the scene file]:UNIT:(mm m)'.
std::string zshOption(const CLI::Option& option) {
  std::string value;
  if (takesValue(option)) {
    const std::vector<std::string> words = wordsOf(option);
    value = fmt::format(":{}:{}", inShort(option.get_option_text()),
                        words.empty() ? "_files" : fmt::format("({})", fmt::join(words, " ")));
  }
  std::string all;
  for (const std::string& name : spellings(option)) {
    const char* equals = takesValue(option) && name.starts_with("--") ? "=" : "";
    all += fmt::format("'*{}{}[{}]{}' ", name, equals, inShort(option.get_description()), value);
  }
  return all;
}

/// An option as fish's `complete` takes it, on a line.
std::string fishOption(const CLI::Option& option, const std::string& condition) {
  std::string lines;
  for (const std::string& name : spellings(option)) {
    const bool is_long = name.starts_with("--");
    lines +=
        fmt::format("complete -c radiosity -n '{}' -{} {} -d '{}'", condition, is_long ? "l" : "s",
                    name.substr(is_long ? 2 : 1), inShort(option.get_description()));
    const std::vector<std::string> words = wordsOf(option);
    if (!words.empty()) {
      lines += fmt::format(" -x -a '{}'", fmt::join(words, " "));
    } else if (takesValue(option)) {
      lines += " -r -F";
    }
    lines += '\n';
  }
  return lines;
}

}  // namespace

std::string bashCompletion(const CLI::App& program) {
  std::string first, options, values;
  for (const CLI::Option* option : namedOptions(program)) {
    first += fmt::format("{} ", fmt::join(spellings(*option), " "));
  }
  for (const CLI::App* command : subcommands(program)) {
    first += command->get_name() + " ";
    options += fmt::format("      {}) words='", command->get_name());
    for (const CLI::Option* option : namedOptions(*command)) {
      options += fmt::format("{} ", fmt::join(spellings(*option), " "));
      const std::vector<std::string> words = wordsOf(*option);
      if (words.empty()) continue;
      for (const std::string& name : spellings(*option)) {
        values += fmt::format("      {}:{}) words='{}' ;;\n", command->get_name(), name,
                              fmt::join(words, " "));
      }
    }
    options += "' ;;\n";
  }
  return fmt::format(kBash, first, options, values);
}

std::string zshCompletion(const CLI::App& program) {
  std::string first, names, commands;
  for (const CLI::Option* option : namedOptions(program)) first += zshOption(*option);
  for (const CLI::App* command : subcommands(program)) {
    names += fmt::format("'{}:{}' ", command->get_name(), inShort(command->get_description()));
    commands += fmt::format("      {}) _arguments ", command->get_name());
    for (const CLI::Option* option : namedOptions(*command)) commands += zshOption(*option);
    commands += "'*:file:_files' ;;\n";
  }
  return fmt::format(kZsh, first, names, commands);
}

std::string fishCompletion(const CLI::App& program) {
  std::string lines;
  for (const CLI::Option* option : namedOptions(program)) {
    lines += fishOption(*option, "__fish_use_subcommand");
  }
  for (const CLI::App* command : subcommands(program)) {
    lines += fmt::format("complete -c radiosity -n __fish_use_subcommand -f -a {} -d '{}'\n",
                         command->get_name(), inShort(command->get_description()));
    for (const CLI::Option* option : namedOptions(*command)) {
      lines += fishOption(*option, "__fish_seen_subcommand_from " + command->get_name());
    }
  }
  return lines;
}

}  // namespace radiosity::cli
