// The page itself: the template, which is built beforehand, with a scene's data.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "radiosity/base.h"

namespace radiosity::page {

/// The page without data, with kDataMark once; empty if the program was built without node and npm.
std::string_view pageTemplate();

inline constexpr std::string_view kDataMark = "<!--radiosity-data-->";

/// Compresses by gzip (RFC 1952), with the same bytes for the same data. Throws Cancelled.
std::string gzipped(std::span<const std::byte> data, Progress& progress);

/// Writes the template with the data, in a script element, in place of the mark. Returns the number
/// of bytes of the data. Errors: RunError if the template lacks the mark, and those of CheckedFile;
/// Cancelled.
std::size_t writeHtml(const std::string& path, std::string_view page_template,
                      std::span<const std::byte> data, Progress& progress);

}  // namespace radiosity::page
