// Writes figures as text, and guesses the word that was meant.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
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

/// Names of the bands: "R", "G", "B"; if there are not three, "band 1", "band 2", ...
std::vector<std::string> bandNames(int bands);
/// All bands, as text after a figure: "R G B", "band 1", "bands 1 to 8".
std::string bandsText(int bands);

/// Parses "512M", "2G", "1.5GiB" or "1000000" (bytes); units are binary. Errors: InputError naming
/// `option`.
std::size_t parseBytes(const std::string& option, const std::string& text);

/// Parses "90", "90s", "10m", "1.5h" (also "min") as seconds. Errors: InputError naming `option`.
double parseDuration(const std::string& option, const std::string& text);

/// The candidate nearest to `word` by edits (insert, delete, replace, swap of neighbours). At most
/// a third of the letters may differ; one always may.
std::optional<std::string> nearest(const std::string& word,
                                   std::span<const std::string> candidates);

/// "; did you mean X?", or an empty text.
std::string suggestion(const std::string& word, std::span<const std::string> candidates);

/// Spells an option of the library (radiosity/spelling.h) as the command line does: "--near exact".
std::string spelledAsOption(std::string_view field, std::string_view value);

/// The word with quotes for a shell, if it needs them.
std::string shellWord(const std::string& word);

/// The text on one line: line breaks become "; ".
std::string oneLine(const std::string& text);

}  // namespace radiosity::cli
