// Names of files.
#pragma once

#include <string>

namespace radiosity {

/// What a path ends in, in small letters and with its dot: ".png"; or empty.
std::string lowerExtension(const std::string& path);

}  // namespace radiosity
