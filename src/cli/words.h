// How the program writes figures and how it guesses what was meant.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace radiosity::cli {

/// "0.34 s", "12 s", "3 min 5 s", "2 h 10 min".
std::string durationText(double seconds);

/// Six significant digits, no trailing zeros; "none" for NaN.
std::string numberText(double value, int digits = 6);

/// An angle in radians, in degrees.
double degrees(double radians);

/// "1 patch", "2,034 patches".
std::string plural(std::size_t count, const std::string& one, const std::string& many);

/// Names of the bands: "R", "G", "B"; where there are not three, "band 1", "band 2", ...
std::vector<std::string> bandNames(int bands);
/// All of them behind a figure: "R G B", "band 1", "bands 1 to 8".
std::string bandsText(int bands);

/// "512M", "2G", "1.5GiB", "1000000" (bytes) -> bytes; units are binary. InputError names `option`.
std::size_t parseBytes(const std::string& option, const std::string& text);

/// Seconds: "90", "90s", "10m", "1.5h" (also "min"). InputError naming `option`.
double parseDuration(const std::string& option, const std::string& text);

/// The candidate nearest to `word` by edits (insert, delete, replace, swap of neighbours), where
/// no more than a third of the letters, and at least one, differ.
std::optional<std::string> nearest(const std::string& word,
                                   std::span<const std::string> candidates);

/// "; did you mean X?" or nothing.
std::string suggestion(const std::string& word, std::span<const std::string> candidates);

/// The text on one line: line breaks become "; ".
std::string oneLine(const std::string& text);

}  // namespace radiosity::cli
