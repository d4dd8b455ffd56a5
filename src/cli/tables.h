// Form factors between named surfaces: on the terminal and in files for people and other programs.
#pragma once

#include "cli/commands.h"

namespace radiosity::cli {

/// InputError for options of tables that nothing asked for uses.
void checkTableOptions(const Request& request, const OutputSet& files);

/// InputError for groups that do not fit the scene: before form factors are computed.
void checkGroups(const Request& request, const Scene& scene);

/// Prints the table of --between or --group and writes those among `files`.
void writeTables(Session& session, Pipeline& pipeline, OutputSet& files);

}  // namespace radiosity::cli
