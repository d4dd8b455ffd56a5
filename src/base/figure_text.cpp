#include "base/figure_text.h"

#include <fmt/format.h>

#include <charconv>
#include <iterator>

namespace radiosity {

std::string countText(std::size_t count) {
  const std::string digits = std::to_string(count);
  std::string text;
  for (std::size_t k = 0; k < digits.size(); ++k) {
    if (k > 0 && (digits.size() - k) % 3 == 0) text += ',';
    text += digits[k];
  }
  return text;
}

std::string bytesText(std::size_t bytes) {
  constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB", "TiB", "PiB"};
  auto value = double(bytes);
  std::size_t unit = 0;
  while (value >= 1024 && unit + 1 < std::size(kUnits)) {
    value /= 1024;
    ++unit;
  }
  if (unit == 0) return fmt::format("{} B", bytes);
  return value < 100 ? fmt::format("{:.1f} {}", value, kUnits[unit])
                     : fmt::format("{:.0f} {}", value, kUnits[unit]);
}

double areaFigure(double area) {
  const std::string digits = fmt::format("{:.12g}", area);
  std::from_chars(digits.data(), digits.data() + digits.size(), area);
  return area;
}

}  // namespace radiosity
