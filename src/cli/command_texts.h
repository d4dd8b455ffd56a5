// Help texts of the subcommands.
#pragma once

#include "cli/request.h"

namespace radiosity::cli {

const char* descriptionOf(Command command);
/// The files it writes and examples, under the options.
const char* examplesOf(Command command);

}  // namespace radiosity::cli
