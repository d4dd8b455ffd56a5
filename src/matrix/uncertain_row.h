// The uncertain entries of one row, a byte each.
#pragma once

#include <cstdint>
#include <vector>

#include "matrix/run_row.h"
#include "radiosity/closure.h"

namespace radiosity {

struct UncertainEntries::Row {
  std::vector<Run> runs;            ///< from position k + 1 on
  std::vector<std::uint8_t> codes;  ///< of the error; 0: known
};

/// The error a code stands for, rounded.
double errorOfCode(std::uint8_t code);

}  // namespace radiosity
