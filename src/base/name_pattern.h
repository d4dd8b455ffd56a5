// Patterns of names, as shells have them.
#pragma once

#include <string_view>

namespace radiosity {

/// Whether `text` holds a character that means something in a pattern: * ? [
bool isPattern(std::string_view text);

/// Whether all of `name` is as `pattern` says: * any text, slashes too; ? a character; [abc] or
/// [a-c] one of some, [!abc] any other; \ takes the next one as it stands. Characters are those of
/// UTF-8; a byte that begins none is one by itself.
bool matchesPattern(std::string_view pattern, std::string_view name);

}  // namespace radiosity
