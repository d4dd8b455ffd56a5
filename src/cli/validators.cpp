#include "cli/validators.h"

#include <fmt/format.h>

#include <charconv>

namespace radiosity::cli {

const CLI::Validator& wholeNumber() {
  constexpr std::size_t kDigits = 18;  // always fits 64 bits
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
        double value = 0;
        const char* last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        return error == std::errc() && end == last && value >= 0
                   ? std::string()
                   : fmt::format("'{}' is not a number from 0 on", text);
      },
      "");
  return kValidator;
}

}  // namespace radiosity::cli
