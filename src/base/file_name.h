// Names of files.
#pragma once

#include <string>

namespace radiosity {

/// The extension of a path in small letters, with its dot: ".png"; empty if there is none.
std::string lowerExtension(const std::string& path);

}  // namespace radiosity
