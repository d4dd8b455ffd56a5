#include "base/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/input_file.h"
#include "base/parse.h"
#include "radiosity/base.h"

namespace radiosity {

namespace {

/// Without blanks at its ends, also those that do not break a line (U+00A0), which come from
/// documents.
std::string_view withoutBlanks(std::string_view text) {
  constexpr std::string_view kBlanks[] = {" ", "\t", "\xc2\xa0"};
  for (bool more = true; more;) {
    more = false;
    for (const std::string_view blank : kBlanks) {
      if (text.starts_with(blank)) text.remove_prefix(blank.size()), more = true;
      if (text.ends_with(blank)) text.remove_suffix(blank.size()), more = true;
    }
  }
  return text;
}

bool isBlank(const std::vector<std::string>& fields) {
  return std::ranges::all_of(fields,
                             [](const auto& field) { return withoutBlanks(field).empty(); });
}

/// Leaves out blank fields at the end, down to `least` fields: spreadsheets write the columns that
/// they show, to the last that ever held anything.
void dropBlankEnd(std::vector<std::string>& fields, std::size_t least) {
  while (fields.size() > least && withoutBlanks(fields.back()).empty()) fields.pop_back();
}

/// Reads one record at a time; a quoted field may span several lines.
class CsvReader {
 public:
  CsvReader(std::string path, std::string_view text) : path_(std::move(path)), text_(text) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // spreadsheets write it
    if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
    if (text_.starts_with("\xff\xfe") || text_.starts_with("\xfe\xff")) {
      fail(1, "is UTF-16; save it as UTF-8");
    }
  }

  /// False at the end.
  bool next(CsvTable::Row& row) {
    while (at_ < text_.size()) {
      row = {line_, {}};
      const std::size_t first = text_.find_first_not_of(" \t", at_);
      const bool is_comment = first != std::string_view::npos && text_[first] == '#';
      if (is_comment) {
        skipLine();
        continue;
      }
      readRecord(row.fields);
      if (!isBlank(row.fields)) return true;
    }
    return false;
  }

  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_, line, what));
  }

 private:
  /// A comment may hold quotes.
  void skipLine() {
    at_ = std::min(text_.find_first_of("\r\n", at_), text_.size() - 1) + 1;
    if (text_[at_ - 1] == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
    ++line_;
  }

  void readRecord(std::vector<std::string>& fields) {
    fields.emplace_back();
    while (at_ < text_.size()) {
      const char c = text_[at_++];
      if (c == '"' && withoutBlanks(fields.back()).empty()) {
        fields.back().clear();
        readQuoted(fields.back());
      } else if (c == ',') {
        fields.emplace_back();
      } else if (c == '\n' || c == '\r') {
        if (c == '\r' && at_ < text_.size() && text_[at_] == '\n') ++at_;
        ++line_;
        return;
      } else {
        fields.back() += c;
      }
    }
  }

  void readQuoted(std::string& field) {
    const std::size_t first = line_;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (c != '"') {
        field += c;
      } else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        field += text_[++at_];
      } else {
        ++at_;
        return;
      }
    }
    fail(first, "a quote is opened and not closed; close it with \"");
  }

  std::string path_;
  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

}  // namespace

std::string csvField(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string out(1, '"');
  for (const char c : text) out.append(c == '"' ? 2 : 1, c);
  out.push_back('"');
  return out;
}

std::optional<std::size_t> CsvTable::column(std::string_view name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) return std::nullopt;
  return std::size_t(found - header.begin());
}

namespace {

/// Refuses semicolons or tabs between columns: spreadsheets write them in countries with a decimal
/// comma.
void requireCommas(const CsvReader& reader, const CsvTable::Row& header) {
  if (header.fields.size() > 1) return;
  const std::string& only = header.fields.front();
  const std::size_t other = only.find_first_of(";\t");
  if (other == std::string::npos) return;
  reader.fail(header.line,
              fmt::format("the header has one column, `{}`; write commas between columns, not {}, "
                          "and points in numbers",
                          only, only[other] == ';' ? "semicolons" : "tabs"));
}

bool isOfNumbers(const CsvTable::Row& row, std::size_t most) {
  return row.fields.size() <= most && std::ranges::all_of(row.fields, [](const auto& field) {
           return parseNumber(withoutBlanks(field)).has_value();
         });
}

void takeHeader(const CsvReader& reader, const CsvTable::Row& row, CsvTable& table) {
  for (const std::string& name : row.fields) {
    table.header.emplace_back(withoutBlanks(name));
    if (std::count(table.header.begin(), table.header.end(), table.header.back()) > 1) {
      reader.fail(row.line, fmt::format("there are two columns '{}'; name each differently",
                                        table.header.back()));
    }
  }
}

void addRow(const CsvReader& reader, CsvTable::Row row, CsvTable& table) {
  dropBlankEnd(row.fields, table.header.size());
  if (row.fields.size() != table.header.size()) {
    reader.fail(row.line, fmt::format("{} fields, and the {} has {}; give one a column, with "
                                      "commas between them and points in numbers",
                                      row.fields.size(), table.has_header ? "header" : "first line",
                                      table.header.size()));
  }
  for (std::string& field : row.fields) field = std::string(withoutBlanks(field));
  table.rows.push_back(std::move(row));
}

}  // namespace

CsvTable readCsv(const std::string& path) { return parseCsv(path, readWholeFile(path)); }

CsvTable parseCsv(const std::string& path, std::string_view text,
                  std::span<const char* const> unnamed) {
  CsvReader reader(path, text);
  CsvTable table;
  table.path = path;
  CsvTable::Row row;
  if (!reader.next(row)) reader.fail(1, "there is no header line; name the columns in the first");
  requireCommas(reader, row);
  dropBlankEnd(row.fields, 1);
  table.header_line = row.line;
  table.has_header = !isOfNumbers(row, unnamed.size());
  if (table.has_header) {
    takeHeader(reader, row, table);
  } else {
    table.header.assign(unnamed.begin(), unnamed.begin() + std::ptrdiff_t(row.fields.size()));
    addRow(reader, std::move(row), table);
  }
  while (reader.next(row)) addRow(reader, std::move(row), table);
  return table;
}

}  // namespace radiosity
