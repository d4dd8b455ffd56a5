// The readers of photometric files.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>

#include "radiosity/photometry.h"

namespace radiosity {

/// IES LM-63. `content` is all of the file, `file` its name in errors. The table is valid.
Photometry readIes(const std::string& file, std::string_view content);
/// EULUMDAT.
Photometry readEulumdat(const std::string& file, std::string_view content);

/// The table, if it is valid; else InputError with the file's name.
Photometry checkedTable(const std::string& file, Photometry table);

/// Whether vertical angles of type C cover what the formats have: 0 to 90, 90 to 180, or both.
bool isVerticalRange(double first, double last);
inline constexpr const char* kVerticalRanges =
    "they go from 0 to 90, 90 to 180 or 0 to 180; add intensities of 0 where it is dark";
/// Between neighbours. A turn without its end is whole if what is left to it is no wider.
double widestStep(std::span<const double> ascending);
/// cd as tables keep them. Calls fail(what, value), which throws, for one below 0 or too large.
float candelaOf(double value, const auto& fail) {
  if (value < 0) fail("an intensity below 0", value);
  if (value > double(std::numeric_limits<float>::max()))
    fail("an intensity beyond all lamps", value);
  return float(value);
}

}  // namespace radiosity
