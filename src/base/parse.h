// Strict parsing of numbers: the whole text must be a number.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The parts between separators, empty ones included.
std::vector<std::string_view> splitAt(std::string_view text, char separator);

/// A finite decimal number that fills the whole of `word`, correctly rounded.
std::optional<double> parseNumber(std::string_view word);

/// A decimal integer that fills the whole of `word`.
std::optional<long long> parseInteger(std::string_view word);

/// "x,y,z" (no blanks) -> three finite numbers.
std::optional<Vec3> parseTriple(std::string_view text);

}  // namespace radiosity
