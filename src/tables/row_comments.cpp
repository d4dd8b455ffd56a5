#include "tables/row_comments.h"

#include <fmt/format.h>

#include "base/parse.h"
#include "base/printable.h"
#include "scene/text.h"

namespace radiosity {

namespace {

/// MatrixMarket has lines of up to 1024 characters.
constexpr std::size_t kLongestRowName = 800;

}  // namespace

std::string rowComment(const NamedFactors& factors, std::size_t i) {
  return fmt::format("row {} area {} sky {} backs {} name {}", i + 1, factors.matrix->area()[i],
                     factors.sky[i], factors.backs[i],
                     printable(factors.names[i]).substr(0, kLongestRowName));
}

std::optional<RowComment> parseRowComment(std::string_view text) {
  const std::vector<std::string_view> words = splitWords(text);
  if (words.size() < 9 || words[0] != "row" || words[2] != "area" || words[4] != "sky" ||
      words[6] != "backs" || words[8] != "name") {
    return std::nullopt;
  }
  const std::optional<long long> row = parseInteger(words[1]);
  const std::optional<double> area = parseNumber(words[3]);
  const std::optional<double> sky = parseNumber(words[5]);
  const std::optional<double> backs = parseNumber(words[7]);
  if (!row || *row < 1 || !area || *area < 0 || !sky || !backs) return std::nullopt;
  const std::size_t after = std::size_t(words[8].data() + words[8].size() - text.data());
  return RowComment{std::size_t(*row - 1), *area, *sky, *backs,
                    std::string(trimmed(text.substr(after)))};
}

}  // namespace radiosity
