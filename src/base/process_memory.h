// The memory of this process.
#pragma once

#include <cstddef>

namespace radiosity {

/// The resident bytes of this process now, libraries included; 0 if unknown.
std::size_t residentBytes();

/// The part of these bytes that files hold as well: mapped files and the program itself.
std::size_t residentFileBytes();

/// The peak of residentBytes() up to now; 0 if unknown.
std::size_t peakBytes();

/// Returns freed memory to the system. Later allocations then add to the memory in use alone.
void returnFreedMemory();

}  // namespace radiosity
