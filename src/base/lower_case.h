// Text in small letters. In the header alone, for the libraries that are loaded when needed, too.
#pragma once

#include <cctype>
#include <string>
#include <string_view>

namespace radiosity {

/// `text` with small ASCII letters.
inline std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace radiosity
