#include "scene/inp/inp_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/lower_case.h"
#include "base/parse.h"

namespace radiosity {

std::string InpPlace::where() const { return fmt::format("{}:{}", *file, cursor->line()); }

long long InpPlace::integer(std::string_view word, const char* what) const {
  const std::optional<long long> value = parseInteger(word);
  if (!value) fail(fmt::format("{} `{}` is not a whole number; correct it", what, word));
  return *value;
}

double InpPlace::coordinate(std::string_view field) const {
  std::string word = lowerCase(field);
  std::replace(word.begin(), word.end(), 'd', 'e');  // Fortran's exponents
  const std::optional<double> value = parseNumber(word);
  if (!value) {
    fail(fmt::format("coordinate `{}` is not a finite number; write it as 1.5 with a decimal point",
                     field));
  }
  return *value;
}

}  // namespace radiosity
