#include "cli/validators.h"

#include <fmt/format.h>

#include "base/parse.h"

namespace radiosity::cli {

const CLI::Validator& wholeNumber() {
  constexpr std::size_t kDigits = 18;  // always fit into 64 bits
  static const CLI::Validator kValidator(
      [](std::string& text) {
        const bool whole = !text.empty() && text.size() <= kDigits &&
                           text.find_first_not_of("0123456789") == std::string::npos;
        return whole ? std::string()
                     : fmt::format("'{}' is not a whole number from 0 to 10^18", text);
      },
      "");
  return kValidator;
}

const CLI::Validator& nonNegative() {
  static const CLI::Validator kValidator(
      [](std::string& text) {
        return parseNumber(text).value_or(-1) >= 0
                   ? std::string()
                   : fmt::format("'{}' is not a number from 0 on", text);
      },
      "");
  return kValidator;
}

}  // namespace radiosity::cli
