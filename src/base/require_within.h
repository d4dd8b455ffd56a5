// Ranges of options.
#pragma once

#include <fmt/format.h>

#include <string_view>

#include "radiosity/base.h"

namespace radiosity {

/// Throws InputError "WHAT is VALUE; it must lie between LOW and HIGH UNIT" unless the value does;
/// NaN does not. `unit` begins with a blank, or is empty.
template <class Number>
void requireWithin(std::string_view what, Number value, Number low, Number high,
                   std::string_view unit = "") {
  if (value >= low && value <= high) return;
  throw InputError(
      fmt::format("{} is {}; it must lie between {} and {}{}", what, value, low, high, unit));
}

}  // namespace radiosity
