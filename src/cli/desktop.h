// The user's desktop, if there is one.
#pragma once

#include <string>

namespace radiosity::cli {

/// Opens a file in the desktop's program for it (xdg-open), without waiting. Does nothing and
/// returns false if standard output is not a terminal, or if there is no display or no xdg-open.
bool openInDesktop(const std::string& path);

}  // namespace radiosity::cli
