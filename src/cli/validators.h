// Checks of option values, beyond what CLI11 has.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "radiosity/base.h"

namespace radiosity::cli {

/// CLI11 reads "-5" into an unsigned number, and too many digits as the largest, without a word.
const CLI::Validator& wholeNumber();
/// CLI11's own names all digits of the largest double.
const CLI::Validator& nonNegative();

/// The value of --sky: one number or three with commas. InputError naming the option.
Vec3 parseSky(const std::string& text);

}  // namespace radiosity::cli
