// Manual pages and completions of shells, from the options as they are declared.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace radiosity::cli {

// completions.cpp
std::string bashCompletion(const CLI::App& program);
std::string zshCompletion(const CLI::App& program);
std::string fishCompletion(const CLI::App& program);

// manuals.cpp
/// Writes radiosity.1, a page for each subcommand and the completions below `folder`, in the
/// folders where programs seek them below PREFIX/share. Files that are there are replaced. Errors:
/// RunError naming the file.
void writeManuals(const CLI::App& program, const std::string& folder);

}  // namespace radiosity::cli
