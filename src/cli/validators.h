// Checks of option values, beyond what CLI11 has.
#pragma once

#include <CLI/CLI.hpp>

namespace radiosity::cli {

/// CLI11 reads "-5" into an unsigned number, and too many digits as the largest, without a word.
const CLI::Validator& wholeNumber();
/// CLI11's own names all digits of the largest double.
const CLI::Validator& nonNegative();

}  // namespace radiosity::cli
