#include "radiosity/option_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "base/figure_text.h"
#include "radiosity/base.h"

namespace radiosity {

namespace {

/// Large whole numbers have all their digits: "20,000,000".
std::string boundText(double bound) {
  constexpr double kLarge = 1e4;
  constexpr double kMostDigits = 1e9;
  const bool counts = bound >= kLarge && bound <= kMostDigits && bound == std::trunc(bound);
  return counts ? countText(std::size_t(bound)) : fmt::format("{:g}", bound);
}

}  // namespace

bool OptionRange::has(double value) const {
  // A bound that is not given is NaN, and no number is beyond it.
  if (!std::isfinite(value) || value < from || value > to || value <= above || value >= below) {
    return false;
  }
  if (only == Only::even) return std::fmod(value, 2) == 0;
  return only != Only::power_of_two || std::has_single_bit(static_cast<unsigned long long>(value));
}

std::string OptionRange::text() const {
  std::string kind = only == Only::even           ? "even, "
                     : only == Only::power_of_two ? "a power of two, "
                                                  : "";
  const bool has_low = !std::isnan(from) || !std::isnan(above);
  const std::string low = std::isnan(above) ? boundText(from) : "above " + boundText(above);
  if (!ends()) return has_low ? kind + low + (std::isnan(above) ? " or more" : "") : "";
  if (!std::isnan(from) && !std::isnan(to)) {
    return kind + boundText(from) + " to " + boundText(to);
  }
  const std::string high =
      std::isnan(below) ? "at most " + boundText(to) : "below " + boundText(below);
  return kind + (has_low ? low + " and " : "") + high;
}

std::string OptionLine::optionName() const {
  std::string dashed = *option != '\0' ? option : name;
  std::ranges::replace(dashed, '_', '-');
  return dashed;
}

std::string OptionLine::helpText(const OptionRange& range) const {
  const auto& [a, b, c, d] = figures;
  const std::string sentence = fmt::format(fmt::runtime(help), a, b, c, d);
  return range.ends() ? sentence + "; " + range.text() : sentence;
}

void requireInRange(const std::string& name, const OptionLine& line, double value,
                    const OptionRange& range) {
  if (range.has(value)) return;
  const std::string allowed = range.text();
  throw InputError(fmt::format("{}: {}{}{} is out of range; {}", name, value,
                               *line.unit != '\0' ? " " : "", line.unit,
                               allowed.empty() ? "a finite number" : allowed));
}

}  // namespace radiosity
