// Tables as comma-separated text (RFC 4180).
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace radiosity {

/// `text` as a field: in quotes if it has separators or quotes.
std::string csvField(std::string_view text);

/// A table with a header line. Lines that are empty, hold only commas or begin with # are
/// skipped, and empty columns at the end left out. Lines end in LF, CR LF or CR.
struct CsvTable {
  struct Row {
    std::size_t line = 0;  ///< of the file, from 1
    std::vector<std::string> fields;
  };
  std::string path;
  bool has_header = true;           ///< or a first line of numbers
  std::size_t header_line = 0;      ///< of the file, from 1
  std::vector<std::string> header;  ///< without blanks at their ends
  std::vector<Row> rows;            ///< each of as many fields as the header

  /// The place of a column.
  std::optional<std::size_t> column(std::string_view name) const;
};

/// `path`: for messages. `unnamed`: the names of columns, from the first, of a table that may do
/// without a header: its first line is all numbers then. Errors: InputError that names file and
/// line: no header, one with other separators, a column twice, a row of another number of fields,
/// quotes that do not end.
CsvTable parseCsv(const std::string& path, std::string_view text,
                  std::span<const char* const> unnamed = {});
/// The same of a file. Errors: as readWholeFile(), too.
CsvTable readCsv(const std::string& path);

}  // namespace radiosity
