// Help that fits a terminal of 100 columns. What -h says of a subcommand fits its height, too: the
// names of the options; --help has their texts (CLI11's mode All).
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace radiosity::cli {

/// All names of an option, then its value: "-o, --output FILE".
std::string namesAndValue(const CLI::Option& option);

class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;

 private:
  std::string namesInGroups(const CLI::App& app) const;
};

}  // namespace radiosity::cli
