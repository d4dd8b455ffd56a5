#include "solve/patch_names.h"

#include <fmt/format.h>

#include <set>

namespace radiosity {

std::string PatchNames::of(std::size_t i) const {
  if (group.empty()) return fmt::format("patch {}", i);
  return fmt::format("patch {} of surface \"{}\"", i, names[group[i]]);
}

std::string PatchNames::list(std::span<const std::size_t> patches) const {
  constexpr std::size_t kListed = 20;
  std::set<Index> seen;
  std::string text;
  for (const std::size_t i : patches) {
    if (!seen.insert(group.empty() ? Index(i) : group[i]).second) continue;
    if (seen.size() > kListed) continue;
    if (!text.empty()) text += ", ";
    text += group.empty() ? fmt::format("patch {}", i) : names[group[i]];
  }
  if (seen.size() > kListed) text += fmt::format(" and {} more", seen.size() - kListed);
  return text;
}

}  // namespace radiosity
