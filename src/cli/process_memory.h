// What this process holds.
#pragma once

#include <cstddef>

namespace radiosity::cli {

/// Bytes of memory that are this process's now, libraries included; 0 where it is not known.
std::size_t residentBytes();

}  // namespace radiosity::cli
