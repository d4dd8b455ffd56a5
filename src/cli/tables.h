// Form factors between named surfaces: on the terminal and in files for people and other programs.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "cli/commands.h"

namespace radiosity::cli {

/// Throws InputError for options of tables if no table was asked for.
void checkTableOptions(const Request& request, const OutputSet& files);

/// Throws InputError for groups that do not fit the surfaces, and for names and numbers of rows
/// that a table would refuse, before form factors are computed. `patches`: 0 if not known yet.
void checkTables(const Session& session, const OutputSet& files,
                 std::span<const std::string> surfaces, std::size_t patches);

/// Prints the table of --between or --group and writes those among `files`, MatrixMarket too.
void writeTables(Session& session, Pipeline& pipeline, OutputSet& files);

}  // namespace radiosity::cli
