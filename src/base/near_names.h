// Names that are like a word: what may have been meant.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace radiosity {

/// Edits that make one of the other: letters inserted, deleted or replaced, neighbours swapped
/// (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// All `names`, those first that hold something like `word`, by the fewest edits. Of a pattern its
/// letters count; capitals are as small letters.
std::vector<std::string> nearestFirst(std::string_view word, std::span<const std::string> names);

}  // namespace radiosity
