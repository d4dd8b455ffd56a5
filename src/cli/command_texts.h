// Help texts of the subcommands.
#pragma once

#include "cli/request.h"

namespace radiosity::cli {

const char* descriptionOf(Command command);
/// The text under the options: files that the subcommand writes, and examples.
const char* examplesOf(Command command);

}  // namespace radiosity::cli
