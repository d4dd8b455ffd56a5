// Tables for people: Markdown, with columns that also line up on a terminal.
#include <fmt/format.h>

#include <algorithm>

#include "base/figure_text.h"
#include "base/printable.h"
#include "results/checked_file.h"
#include "tables/table_rows.h"

namespace radiosity {

namespace {

using Cells = std::vector<std::string>;

std::string cellOf(const std::string& name) {
  std::string out;
  for (const char c : printable(name)) {
    if (c == '|') out.push_back('\\');
    out.push_back(c);
  }
  return out;
}

std::string numberOf(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

/// The first `text` columns hold words, the others numbers.
std::string markdownOf(const std::vector<Cells>& rows, std::size_t text) {
  std::vector<std::size_t> width(rows.front().size(), 3);
  for (const Cells& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) width[c] = std::max(width[c], row[c].size());
  }
  std::string out;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < width.size(); ++c) {
      out += c < text ? fmt::format("| {:<{}} ", rows[r][c], width[c])
                      : fmt::format("| {:>{}} ", rows[r][c], width[c]);
    }
    out += "|\n";
    if (r > 0) continue;
    for (std::size_t c = 0; c < width.size(); ++c) {
      out += '|' + std::string(width[c] + (c < text ? 2 : 1), '-') + (c < text ? "" : ":");
    }
    out += "|\n";
  }
  return out;
}

/// The rows of a table. Rows beyond `most` are only counted.
class Table {
 public:
  Table(Cells header, std::size_t most) : rows_({std::move(header)}), most_(most) {}
  bool isFull() const { return rows_.size() > most_; }
  void add(Cells row) {
    if (isFull()) {
      ++left_;
    } else {
      rows_.push_back(std::move(row));
    }
  }
  std::string text(std::size_t words) const {
    std::string out = markdownOf(rows_, words);
    if (left_ > 0) out += fmt::format("\n... and {} rows more\n", countText(left_));
    return out;
  }

 private:
  std::vector<Cells> rows_;
  std::size_t most_;
  std::size_t left_ = 0;
};

std::string wide(const NamedFactors& factors, int digits, std::size_t most) {
  Cells header = {"from", "area m^2"};
  for (std::size_t b = 0; b < factors.size(); ++b) header.push_back(cellOf(labelOf(factors, b)));
  header.insert(header.end(), {cellOf(factors.sky_name), "backs"});
  if (!factors.error.empty()) header.push_back("error");
  Table table(std::move(header), most);
  Progress quiet;
  forDenseRows(factors, "", quiet, [&](std::size_t a, const std::vector<double>& row) {
    Cells cells = {cellOf(labelOf(factors, a)), numberOf(factors.matrix->area()[a], digits)};
    for (const double value : row) cells.push_back(numberOf(value, digits));
    cells.push_back(numberOf(factors.sky[a], digits));
    cells.push_back(numberOf(factors.backs[a], digits));
    if (!factors.error.empty()) cells.push_back(numberOf(factors.error[a], 2));
    table.add(std::move(cells));
  });
  return table.text(1);
}

std::string longRows(const NamedFactors& factors, int digits, std::size_t most) {
  Cells header = {"from", "to", "area m^2", "F"};
  if (!factors.error.empty()) header.push_back("error");
  Table table(std::move(header), most);
  Progress quiet;
  forDenseRows(factors, "", quiet, [&](std::size_t a, const std::vector<double>& row) {
    const auto add = [&](const std::string& to, double value, const std::string& error) {
      Cells cells = {cellOf(labelOf(factors, a)), cellOf(to),
                     numberOf(factors.matrix->area()[a], digits), numberOf(value, digits)};
      if (!factors.error.empty()) cells.push_back(error);
      table.add(std::move(cells));
    };
    for (std::size_t b = 0; b < row.size(); ++b) {
      if (factors.numbered && row[b] == 0) continue;
      add(labelOf(factors, b), row[b], numberOf(factors.entryError(a, b), 2));
    }
    add(factors.sky_name, factors.sky[a], "");
    add("backs", factors.backs[a], "");
  });
  return table.text(2);
}

}  // namespace

std::string factorsMarkdown(const NamedFactors& factors, TableLayout layout, int digits,
                            std::size_t most) {
  requireDistinctNames("table", factors);
  return layout == TableLayout::wide ? wide(factors, digits, most)
                                     : longRows(factors, digits, most);
}

void writeFactorsMarkdown(const std::string& path, const NamedFactors& factors,
                          TableLayout layout) {
  checkTableRows(path, factors, TableLayout::wide);
  CheckedFile file(path);
  file.write(factorsMarkdown(factors, layout));
  file.commit();
}

}  // namespace radiosity
