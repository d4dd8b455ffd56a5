// Words in scene files and in messages about them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"

namespace radiosity {

/// The characters that separate words.
inline constexpr std::string_view kBlanks = " \t\r\n\v\f";

/// `text` without blanks at both ends.
std::string_view trimmed(std::string_view text);

/// `text` trimmed, with blanks for line ends, for a library's message inside one of ours.
std::string onOneLine(std::string_view text);

/// The words between blanks (kBlanks).
std::vector<std::string_view> splitWords(std::string_view text);

/// "a, b, c"; with more than `limit` names "... and 5 more".
std::string joinNames(std::span<const std::string> names, std::size_t limit = 12);

/// "0.5" if all bands are equal, else "0.6 0.1 0.1".
std::string describeBands(const Vec3& value);

}  // namespace radiosity
