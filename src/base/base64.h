// Bytes as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace radiosity {

/// RFC 4648, padded.
std::string base64(std::string_view bytes);
/// The inverse, also of a text without its padding; none: it is not such a text.
std::optional<std::string> ofBase64(std::string_view text);

}  // namespace radiosity
