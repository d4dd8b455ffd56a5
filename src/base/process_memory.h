// What this process holds.
#pragma once

#include <cstddef>

namespace radiosity {

/// Bytes of memory that are this process's now, libraries included; 0 where it is not known.
std::size_t residentBytes();

/// Of these, the ones that files hold as well: mapped files, the program itself among them.
std::size_t residentFileBytes();

/// The most that were, up to now; 0 where it is not known.
std::size_t peakBytes();

/// Gives memory back that was freed: what comes next then adds to what is held, not to what was.
void returnFreedMemory();

}  // namespace radiosity
