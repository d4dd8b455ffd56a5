// Patterns of names, like those of shells.
#pragma once

#include <string_view>

namespace radiosity {

/// Whether `text` has a character with a meaning in a pattern: * ? [
bool isPattern(std::string_view text);

/// Whether the whole `name` matches `pattern`: * any text, slashes too; ? one character; [abc] or
/// [a-c] one of these, [!abc] any other; \ takes the next one literally. Characters are those of
/// UTF-8; a byte that does not begin one counts as a character.
bool matchesPattern(std::string_view pattern, std::string_view name);

}  // namespace radiosity
