// Memory for the rows of form factors: in memory or, if they do not fit, in scratch memory.
#pragma once

#include <cstddef>
#include <memory>

#include "radiosity/form_factors.h"

namespace radiosity {

/// The memory that a computation holds at once.
struct RowMemory {
  std::size_t bytes = 0;          ///< in memory, including what others hold
  std::size_t scratch_bytes = 0;  ///< in scratch memory, on the disk; 0: nothing
  std::size_t resident = 0;       ///< the part of these in memory at a time, about
};

/// Plans a computation that takes `whole` bytes with all in memory, or `beside` bytes in memory and
/// `rows` in scratch memory.
RowMemory planRowMemory(std::size_t whole, std::size_t beside, std::size_t rows,
                        const FormFactorOptions& options);

/// The memory of one of several processes that share the rows, all of them in memory.
RowMemory shareOf(const RowMemory& memory, std::size_t matrix_bytes, int processes);

/// The most bytes that a symmetric matrix takes in panels.
std::size_t panelsOf(std::size_t matrix_bytes, Precision precision);

/// Null if all is in memory. Throws RunError, with the numbers, if more is needed than the limit,
/// or the scratch file cannot be made.
std::shared_ptr<ScratchMemory> makeRowMemory(const RowMemory& memory,
                                             const FormFactorOptions& options, std::size_t patches);

}  // namespace radiosity
