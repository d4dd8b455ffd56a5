// Words of scene files and of messages about them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// What separates words.
inline constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// Without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// Trimmed, line ends turned into blanks: a library's message fit for one of ours.
std::string onOneLine(std::string_view text);

/// Words between blanks (space, tab, carriage return).
std::vector<std::string_view> splitWords(std::string_view text);

/// ASCII letters as small ones.
std::string lowerCase(std::string_view text);

/// "a, b, c", and where there are more than `limit` names "... and 5 more".
std::string joinNames(std::span<const std::string> names, std::size_t limit = 12);

/// "0.5" where all bands agree, else "0.6 0.1 0.1".
std::string describeBands(const Vec3& value);

}  // namespace radiosity
