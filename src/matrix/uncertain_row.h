// The uncertain entries of one row, a byte each.
#pragma once

#include <cstdint>
#include <memory_resource>
#include <vector>

#include "matrix/run_row.h"
#include "radiosity/closure.h"

namespace radiosity {

struct UncertainEntries::Row {
  Row() = default;
  explicit Row(std::pmr::memory_resource* memory) : runs(memory), codes(memory) {}

  std::uint8_t own = 0;                  ///< the code of the diagonal
  std::pmr::vector<Run> runs;            ///< from position k + 1 on
  std::pmr::vector<std::uint8_t> codes;  ///< of the error; 0: known
};

std::size_t bytesOf(const UncertainEntries::Row& row);

/// The rounded error that a code stands for.
double errorOfCode(std::uint8_t code);

}  // namespace radiosity
