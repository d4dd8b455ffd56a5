// Names that are similar to a word, for suggestions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace radiosity {

/// The fewest edits that turn one text into the other: letters inserted, deleted or replaced,
/// neighbours swapped (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// All `names`, sorted by the fewest edits between `word` and a part of the name. Of a pattern only
/// the letters count; case is ignored.
std::vector<std::string> nearestFirst(std::string_view word, std::span<const std::string> names);

}  // namespace radiosity
