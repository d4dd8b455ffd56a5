// Counts and sizes as people read them.
#pragma once

#include <cstddef>
#include <string>

namespace radiosity {

/// 1234567 -> "1,234,567".
std::string countText(std::size_t count);

/// Bytes with a binary unit: "512 B", "41.2 MiB".
std::string bytesText(std::size_t bytes);

/// An area for tables that people read, with the 12 digits that sums are good for: 12 m^2 is 12 and
/// not 11.999999999999972.
double areaFigure(double area);

}  // namespace radiosity
