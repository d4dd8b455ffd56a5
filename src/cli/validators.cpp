#include "cli/validators.h"

#include <fmt/format.h>

#include <charconv>

#include "base/parse.h"

namespace radiosity::cli {

namespace {

/// A matrix of more is that of patches.
constexpr std::size_t kMostNodes = 10'000;

}  // namespace

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

const CLI::Validator& rowsOfTables() {
  static const CLI::Validator kValidator(
      [](const std::string& text) -> std::string {
        for (const char* word : {"groups", "surfaces", "patches"}) {
          if (text == word) return "";
        }
        std::size_t nodes = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), nodes);
        const bool whole = error == std::errc() && end == text.data() + text.size();
        if (whole && nodes >= 1 && nodes <= kMostNodes) return "";
        return fmt::format(
            "'{}' is not groups, surfaces, patches, or a number of nodes from 1 to {}", text,
            kMostNodes);
      },
      "");
  return kValidator;
}

}  // namespace radiosity::cli
