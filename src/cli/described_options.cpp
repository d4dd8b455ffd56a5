// Options of the command line from the lists of structs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "cli/options.h"
#include "cli/words.h"

namespace radiosity::cli {

namespace {

/// With the default, if the text does not say it.
std::string helpOf(const Option& option) {
  std::string help = option.line.helpText(option.range);
  const bool says_default = help.find("efault") != std::string::npos;
  if (!says_default && !isFlag(option) && !option.text.empty())
    help += fmt::format(" (default {})", option.text);
  return help;
}

CLI::Option* addFlag(CLI::App& app, const std::string& name, const Option& option,
                     const std::function<void(const std::string&)>& take) {
  return app.add_flag_function(
      fmt::format("--{0},!--no-{0}", name),
      [take](std::int64_t count) { take(count > 0 ? "on" : "off"); }, helpOf(option));
}

}  // namespace

void addOptions(CLI::App& app, Request& r, const char* group, const std::vector<Option>& options) {
  const bool compares = app.get_name() == commandName(Command::compare);
  for (const Option& option : options) {
    const std::string name = option.line.optionName();
    // In `compare`, --tolerance is that of the difference.
    const std::string called = compares && name == "tolerance" ? "factor-tolerance" : name;
    const std::string spelled = "--" + called;
    if (*option.line.help == '\0' || app.get_option_no_throw(spelled) != nullptr) continue;
    const bool bytes = option.line.value == std::string_view("SIZE");
    const auto take = [&r, name, spelled, bytes](const std::string& text) {
      r.given.add(name, spelled, {bytes ? fmt::format("{}", parseBytes(spelled, text)) : text});
    };
    if (isFlag(option)) {
      addFlag(app, called, option, take)->group(group);
      continue;
    }
    const auto take_all = [&r, name, spelled](const std::vector<std::string>& texts) {
      r.given.add(name, spelled, texts);
    };
    CLI::Option* added =
        option.repeated
            ? app.add_option_function<std::vector<std::string>>(spelled, take_all, helpOf(option))
            : app.add_option_function<std::string>(spelled, take, helpOf(option));
    added->group(group)->option_text(option.line.value)->allow_extra_args(false);
    if (!option.words.empty()) added->check(CLI::IsMember(option.words));
  }
}

}  // namespace radiosity::cli
