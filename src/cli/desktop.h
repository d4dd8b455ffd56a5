// The person's desktop, where there is one.
#pragma once

#include <string>

namespace radiosity::cli {

/// Opens a file in the program that the desktop has for it (xdg-open), and does not wait for it.
/// False, and nothing happens, where standard output is no terminal, or there is no display or no
/// xdg-open.
bool openInDesktop(const std::string& path);

}  // namespace radiosity::cli
