#include "base/near_names.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace radiosity {

namespace {

/// The fewest edits between `word` and a part of `name` (Sellers 1980). The part may begin and end
/// anywhere at no cost.
std::size_t distanceWithin(std::string_view word, std::string_view name) {
  std::vector<std::size_t> row(name.size() + 1, 0);
  for (std::size_t i = 1; i <= word.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= name.size(); ++j) {
      const std::size_t replaced = diagonal + (word[i - 1] == name[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return *std::min_element(row.begin(), row.end());
}

/// `text` in small letters, without the special characters of patterns.
std::string plainLetters(std::string_view text) {
  std::string letters;
  for (const char c : text) {
    if (std::string_view("*?[]").find(c) != std::string_view::npos) continue;
    letters += char(std::tolower(static_cast<unsigned char>(c)));
  }
  return letters;
}

}  // namespace

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

std::vector<std::string> nearestFirst(std::string_view word, std::span<const std::string> names) {
  const std::string letters = plainLetters(word);
  std::vector<std::pair<std::size_t, std::size_t>> order;  // edits, place
  order.reserve(names.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    order.emplace_back(distanceWithin(letters, plainLetters(names[k])), k);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::string> sorted;
  sorted.reserve(names.size());
  for (const auto& [edits, place] : order) sorted.push_back(names[place]);
  return sorted;
}

}  // namespace radiosity
