// Checks of option values, beyond what CLI11 has.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "radiosity/base.h"

namespace radiosity::cli {

/// Accepts an integer of 0 or more. CLI11 itself silently reads "-5" as an unsigned number, and too
/// many digits as the largest.
const CLI::Validator& wholeNumber();
/// Accepts a number of 0 or more. CLI11's own validator prints all digits of the largest double.
const CLI::Validator& nonNegative();
/// Accepts a value of --between: a word, or a number of nodes.
const CLI::Validator& rowsOfTables();

}  // namespace radiosity::cli
