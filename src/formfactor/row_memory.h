// Where the rows of form factors are to be: in memory, or where they do not fit, in scratch memory.
#pragma once

#include <cstddef>
#include <memory>

#include "radiosity/form_factors.h"

namespace radiosity {

/// What a computation holds at once.
struct RowMemory {
  std::size_t bytes = 0;          ///< in memory, what others hold included
  std::size_t scratch_bytes = 0;  ///< in scratch memory, on the disk; 0: nothing
  std::size_t resident = 0;       ///< of these, in memory at a time, about
};

/// Of a computation that takes `whole` bytes where all is in memory; or `beside` bytes and, in
/// scratch memory, `rows`.
RowMemory planRowMemory(std::size_t whole, std::size_t beside, std::size_t rows,
                        const FormFactorOptions& options);

/// Of one of some processes that share the rows, all of them in memory.
RowMemory shareOf(const RowMemory& memory, std::size_t matrix_bytes, int processes);

/// The most bytes that a symmetric matrix takes in panels.
std::size_t panelsOf(std::size_t matrix_bytes, Precision precision);

/// Null where all is in memory. RunError, with the numbers, where more is needed than the limit, or
/// the scratch file cannot be made.
std::shared_ptr<ScratchMemory> makeRowMemory(const RowMemory& memory,
                                             const FormFactorOptions& options, std::size_t patches);

}  // namespace radiosity
