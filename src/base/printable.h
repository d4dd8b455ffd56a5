// Makes text from files safe for terminals, which would take control characters for commands, and
// for XML and HTML.
#pragma once

#include <string>
#include <string_view>

namespace radiosity {

/// `text` with every control character (C0, DEL, C1) and every byte that is not UTF-8 written as
/// \n, \t, \r or \xNN. Everything else stays.
std::string printable(std::string_view text);

/// `text` with markup characters as entities. Control characters, which XML cannot represent, are
/// '_'.
std::string markupText(std::string_view text);

}  // namespace radiosity
