// Sizes as people read them.
#pragma once

#include <cstddef>
#include <string>

namespace radiosity {

/// Bytes with a binary unit: "512 B", "41.2 MiB".
std::string bytesText(std::size_t bytes);

}  // namespace radiosity
