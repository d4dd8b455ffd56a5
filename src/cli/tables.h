// Form factors between named surfaces: on the terminal and in files for people and other programs.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "cli/commands.h"

namespace radiosity::cli {

/// InputError for options of tables that nothing asked for uses.
void checkTableOptions(const Request& request, const OutputSet& files);

/// InputError for groups that do not fit the surfaces, and for names and numbers of rows that one
/// of the tables to come would refuse: before form factors are computed. `unknowns`: 0 where they
/// are not known yet.
void checkTables(const Session& session, const OutputSet& files,
                 std::span<const std::string> surfaces, std::size_t unknowns);

/// Prints the table of --between or --group and writes those among `files`.
void writeTables(Session& session, Pipeline& pipeline, OutputSet& files);

}  // namespace radiosity::cli
