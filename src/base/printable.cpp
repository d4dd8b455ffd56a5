#include "base/printable.h"

#include <fmt/format.h>

#include <cstddef>

namespace radiosity {

namespace {

unsigned byteAt(std::string_view text, std::size_t k) {
  return static_cast<unsigned char>(text[k]);
}

bool isContinuation(std::string_view text, std::size_t k) {
  return k < text.size() && (byteAt(text, k) & 0xc0u) == 0x80u;
}

/// The number of bytes of the UTF-8 character that begins at `k`; 0 if none begins there (overlong
/// forms do not count).
std::size_t characterLength(std::string_view text, std::size_t k) {
  const unsigned first = byteAt(text, k);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xc2 && first <= 0xdf   ? 2
                             : first >= 0xe0 && first <= 0xef ? 3
                             : first >= 0xf0 && first <= 0xf4 ? 4
                                                              : 0;
  for (std::size_t m = 1; m < length; ++m) {
    if (!isContinuation(text, k + m)) return 0;
  }
  const bool overlong = (first == 0xe0 && byteAt(text, k + 1) < 0xa0) ||
                        (first == 0xf0 && byteAt(text, k + 1) < 0x90);
  return overlong ? 0 : length;
}

/// True for C1, U+0080 to U+009F: terminals interpret them like ESC and a letter.
bool isControl(std::string_view character) {
  if (character.size() == 1) return character[0] == '\x7f' || byteAt(character, 0) < 0x20;
  return character.size() == 2 && byteAt(character, 0) == 0xc2 && byteAt(character, 1) < 0xa0;
}

void quote(char c, std::string& out) {
  if (c == '\n') {
    out += "\\n";
  } else if (c == '\t') {
    out += "\\t";
  } else if (c == '\r') {
    out += "\\r";
  } else {
    out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
  }
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t k = 0; k < text.size();) {
    const std::size_t length = characterLength(text, k);
    const std::string_view character = text.substr(k, length == 0 ? 1 : length);
    k += character.size();
    if (length > 0 && !isControl(character)) {
      out += character;
    } else {
      for (const char c : character) quote(c, out);
    }
  }
  return out;
}

std::string markupText(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 ? '_' : c;
    }
  }
  return out;
}

}  // namespace radiosity
