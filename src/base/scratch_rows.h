// Rows in memory, or in scratch memory if there is some.
#pragma once

#include "radiosity/scratch_memory.h"

namespace radiosity {

/// The memory resource for the storage of rows. `scratch` may be null.
inline std::pmr::memory_resource* rowMemory(ScratchMemory* scratch) {
  if (scratch != nullptr) return scratch;
  return std::pmr::get_default_resource();
}

/// Reports that `bytes` of rows are being read or written. `scratch` may be null.
inline void touchRows(ScratchMemory* scratch, std::size_t bytes) {
  if (scratch != nullptr) scratch->touched(bytes);
}

}  // namespace radiosity
