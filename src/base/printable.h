// Makes text from files safe for terminals, which would take control characters for commands.
#pragma once

#include <string>
#include <string_view>

namespace radiosity {

/// `text` with every control character (C0, DEL, C1) and every byte that is not UTF-8 written as
/// \n, \t, \r or \xNN. Everything else stays.
std::string printable(std::string_view text);

}  // namespace radiosity
