// EnergyPlus, Input Output Reference, "ZoneProperty:UserViewFactors:BySurfaceName".
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "base/lower_case.h"
#include "radiosity/spelling.h"
#include "results/checked_file.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

/// The longest name of an EnergyPlus object.
constexpr std::size_t kLongestIdfName = 100;

void requireName(const std::string& path, const std::string& name) {
  const bool plain = std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return c == ',' || c == ';' || c == '!' || c < 0x20;
  });
  if (plain && !name.empty() && name.size() <= kLongestIdfName) return;
  throw InputError(fmt::format(
      "{}: '{}' is no name for EnergyPlus: 1 to {} characters without comma, semicolon and "
      "exclamation mark; rename it ({})",
      path, name, kLongestIdfName, spelled("groups", "NEW=OLD")));
}

/// The largest factor that EnergyPlus takes (IDD: \maximum 1.0), but for the digits not written.
constexpr double kMostFactor = 1 + 5e-12;

void requireFactor(const std::string& path, const NamedFactors& factors, std::size_t a,
                   std::size_t b, double value) {
  if (value < kMostFactor) return;
  throw InputError(
      fmt::format("{}: F from {} to {} is {}, and EnergyPlus takes 1 at most; ask for a smaller "
                  "{}, or for {}",
                  path, factors.names[a], factors.names[b], value, spelled("tolerance"),
                  spelled("closure", "enforce")));
}

/// EnergyPlus compares names without regard to case.
void requireNames(const std::string& path, const NamedFactors& factors) {
  if (factors.numbered) {
    throw InputError(path + ": EnergyPlus has view factors between surfaces; leave out " +
                     spelled("between", "patches"));
  }
  std::map<std::string, std::string> seen;
  for (const std::string& name : factors.names) {
    requireName(path, name);
    const auto [other, added] = seen.emplace(lowerCase(name), name);
    if (added) continue;
    throw InputError(fmt::format(
        "{}: {} and {} are one name for EnergyPlus, which ignores case; rename one ({})", path,
        other->second, name, spelled("groups", "NEW=OLD")));
  }
}

}  // namespace

void checkEnergyPlusRows(const std::string& path, const NamedFactors& rows,
                         const std::string& zone) {
  requireNames(path, rows);
  requireName(path, zone);
}

void writeEnergyPlus(const std::string& path, const NamedFactors& factors, const std::string& zone,
                     Progress& progress) {
  checkEnergyPlusRows(path, factors, zone);
  CheckedFile file(path);
  file.write(fmt::format(
      "! Form factors by radiosity: from surface, to surface, F. EnergyPlus takes the zone to be\n"
      "! closed: what goes to the sky or to black backs is missing from the rows.\n"
      "ZoneProperty:UserViewFactors:BySurfaceName,\n  {}",
      zone));
  forDenseRows(factors, "writing the table", progress,
               [&](std::size_t a, const std::vector<double>& row) {
                 fmt::memory_buffer lines;
                 for (std::size_t b = 0; b < row.size(); ++b) {
                   requireFactor(path, factors, a, b, row[b]);
                   fmt::format_to(std::back_inserter(lines), ",\n  {},{},{:.12g}", factors.names[a],
                                  factors.names[b], row[b]);
                 }
                 file.write(lines.data(), lines.size());
               });
  file.write(";\n");
  file.commit();
}

}  // namespace radiosity
