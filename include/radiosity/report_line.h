// A report names its figures once: its describe(list, report) calls list(line, field) of each.
// From that come the attributes of results files, Python's dictionaries, the lines that people read
// and the keys of --report.
#pragma once

namespace [[gnu::visibility("default")]] radiosity {

/// What a figure is called.
struct ReportLine {
  const char* name;        ///< in results files and Python
  const char* label = "";  ///< for people; two blanks in front: of the line before; empty: no line
  const char* unit = "";   ///< "s" and "bytes" are told in words: "2 min", "3 MiB"
  /// In --report; empty: the name and the unit, "longest_edge_m", of seconds and bytes the name.
  const char* key = "";
};

}  // namespace radiosity
