// Reads MatrixMarket (Boisvert, Pozo & Remington 1996, NISTIR 5935).
#include <fmt/format.h>

#include <algorithm>

#include "base/input_file.h"
#include "base/lower_case.h"
#include "base/parse.h"
#include "scene/text.h"
#include "tables/matrix_readers.h"
#include "tables/matrix_rows.h"
#include "tables/row_comments.h"

namespace radiosity {

namespace {

class Reader {
 public:
  Reader(const std::string& path, std::string_view text) : path_(path), text_(text) {}

  MatrixFile read(std::span<const double> given, Progress& progress) {
    readBanner();
    readSize();
    progress.begin("reading MatrixMarket", stated_);
    std::vector<Entry> entries;
    entries.reserve(std::min(stated_ * (symmetric_ ? 2 : 1), text_.size() / 2));
    while (nextLine()) {
      if (seen_ % 65536 == 0) progress.check();
      addEntry(entries);
      progress.advance();
    }
    progress.end();
    if (seen_ != stated_) {
      fail(fmt::format("ends after {} of {} entries; write it again", seen_, stated_));
    }
    return made(std::move(entries), given);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_, line_number_, what));
  }

  /// Moves to the next line that is neither empty nor a comment. Keeps comments on rows.
  bool nextLine() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      line_ = trimmed(text_.substr(at_, end - at_));
      at_ = end + 1;
      ++line_number_;
      if (line_.starts_with('%')) {
        if (const auto comment = parseRowComment(line_.substr(1))) comments_.push_back(*comment);
      } else if (!line_.empty()) {
        return true;
      }
    }
    return false;
  }

  void readBanner() {
    const std::size_t end = std::min(text_.find('\n'), text_.size());
    const std::string banner = lowerCase(text_.substr(0, end));
    const std::vector<std::string_view> words = splitWords(banner);
    at_ = end + 1;
    line_number_ = 1;
    const auto isOneOf = [&](std::size_t k, std::string_view a, std::string_view b) {
      return words.size() > k && (words[k] == a || words[k] == b);
    };
    if (words.size() != 5 || words[1] != "matrix" || !isOneOf(2, "coordinate", "array") ||
        !isOneOf(3, "real", "integer") || !isOneOf(4, "general", "symmetric")) {
      fail(
          "is not `matrix coordinate|array real|integer general|symmetric`; write form factors as "
          "one of these");
    }
    dense_ = words[2] == "array";
    symmetric_ = words[4] == "symmetric";
  }

  std::size_t countIn(std::string_view word) const {
    const std::optional<long long> value = parseInteger(word);
    if (!value || *value < 0) fail(fmt::format("`{}` is no count", word));
    return std::size_t(*value);
  }

  void readSize() {
    if (!nextLine()) fail("ends before the size; write it again");
    const std::vector<std::string_view> words = splitWords(line_);
    if (words.size() != (dense_ ? 2 : 3)) fail("the line of the size has another number of words");
    n_ = countIn(words[0]);
    if (n_ != countIn(words[1])) {
      fail(
          fmt::format("is {} x {}; form factors have as many columns as rows", words[0], words[1]));
    }
    if (n_ == 0 || n_ >= kNone) {
      fail(fmt::format("has {} rows; form factors have 1 to {}, a row a patch", n_, kNone - 1));
    }
    if (n_ > text_.size()) {
      fail(fmt::format("claims {} rows and is too short for them; write it again", n_));
    }
    stated_ = dense_ ? (symmetric_ ? n_ * (n_ + 1) / 2 : n_ * n_) : countIn(words[2]);
    if (stated_ > text_.size() / 2 + 1) {
      fail(fmt::format("claims {} entries and is too short for them; write it again", stated_));
    }
  }

  Index indexIn(std::string_view word) const {
    const std::optional<long long> value = parseInteger(word);
    if (!value || *value < 1 || std::size_t(*value) > n_) {
      fail(fmt::format("`{}` is no row or column: they go from 1 to {}", word, n_));
    }
    return Index(*value - 1);
  }

  double valueIn(std::string_view word) const {
    const std::optional<double> value = parseNumber(word);
    if (!value || *value < 0) {
      fail(fmt::format("`{}` is no form factor: a finite number, 0 or more", word));
    }
    return *value;
  }

  void addEntry(std::vector<Entry>& entries) {
    if (seen_ == stated_) fail(fmt::format("there are more than the {} entries stated", stated_));
    const std::vector<std::string_view> words = splitWords(line_);
    if (words.size() != (dense_ ? 1 : 3)) {
      fail(dense_ ? "has more than one value" : "is not `row column value`");
    }
    Entry entry;
    if (dense_) {  // column by column; in a symmetric matrix from the diagonal down
      entry = {Index(dense_row_), Index(dense_column_), valueIn(words[0])};
      if (++dense_row_ == n_) {
        ++dense_column_;
        dense_row_ = symmetric_ ? dense_column_ : 0;
      }
    } else {
      entry = {indexIn(words[0]), indexIn(words[1]), valueIn(words[2])};
    }
    ++seen_;
    entries.push_back(entry);
    if (symmetric_ && entry.row != entry.column) {
      entries.push_back({entry.column, entry.row, entry.value});
    }
  }

  MatrixFile made(std::vector<Entry> entries, std::span<const double> given) const {
    MatrixFile file;
    NamedFactors& factors = file.factors;
    const bool said = saysAllRows();
    std::vector<double> area(n_, 1.0);
    factors.names.resize(n_);
    file.has_areas = said || !given.empty();
    file.has_accounts = said;
    if (said) {
      factors.sky.resize(n_);
      factors.backs.resize(n_);
      for (const RowComment& comment : comments_) {
        area[comment.row] = comment.area;
        factors.sky[comment.row] = comment.sky;
        factors.backs[comment.row] = comment.backs;
        factors.names[comment.row] = comment.name;
      }
    }
    area = chosenAreas(path_, given, std::move(area));
    factors.matrix = std::make_shared<const RowMatrix>(
        matrixOfEntries(path_, std::move(entries), std::move(area)));
    return file;
  }

  /// Whether there is exactly one comment for each row; otherwise comments are ignored.
  bool saysAllRows() const {
    if (comments_.size() != n_) return false;
    for (std::size_t i = 0; i < n_; ++i) {
      if (comments_[i].row != i) return false;
    }
    return true;
  }

  const std::string& path_;
  std::string_view text_;
  std::string_view line_;
  std::size_t at_ = 0;
  std::size_t line_number_ = 0;
  bool dense_ = false;
  bool symmetric_ = false;
  std::size_t n_ = 0;
  std::size_t stated_ = 0;
  std::size_t seen_ = 0;
  std::size_t dense_row_ = 0;
  std::size_t dense_column_ = 0;
  std::vector<RowComment> comments_;
};

}  // namespace

MatrixFile readMatrixMarket(const std::string& path, std::span<const double> area,
                            Progress& progress) {
  const std::string text = readWholeFile(path);
  return Reader(path, text).read(area, progress);
}

}  // namespace radiosity
