// The page itself: the browser's half, made beforehand, with a scene's data put in.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "radiosity/base.h"

namespace radiosity::page {

/// The page without data, in which kDataMark stands once; empty where the program was built
/// without node and npm.
std::string_view pageTemplate();

inline constexpr std::string_view kDataMark = "<!--radiosity-data-->";

/// gzip (RFC 1952), the same bytes for the same data. Throws Cancelled.
std::string gzipped(std::span<const std::byte> data, Progress& progress);

/// Writes `before` the mark, the data in a script element of its own, and what is after it. Returns
/// how many bytes the data takes. Errors: RunError where the template lacks the mark and as
/// CheckedFile; Cancelled.
std::size_t writeHtml(const std::string& path, std::string_view page_template,
                      std::span<const std::byte> data, Progress& progress);

}  // namespace radiosity::page
