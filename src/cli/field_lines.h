// The lines of a summary from the figures that a report describes.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cli/report.h"
#include "radiosity/names.h"
#include "radiosity/report_line.h"

namespace radiosity::cli {

/// Prints and records the figures of a report that have a label.
class FieldLines {
 public:
  explicit FieldLines(Report& report) : report_(report) {}

  /// More lines for after that of a figure or of a part.
  void after(std::string_view name, std::function<void()> lines) {
    further_[name] = std::move(lines);
  }

  void operator()(const ReportLine& line, const auto& value) {
    if (*line.label != '\0') print(line, value);
    further(line.name);
  }
  void operator()(const ReportLine& line, const std::vector<double>& /*values*/) {
    further(line.name);
  }
  void part(const char* name, const auto& /*report*/) { further(name); }
  void table(const char* /*name*/, const auto& /*records*/, const auto& /*columns*/) {}
  void notes(const std::vector<Note>& /*notes*/) {}

 private:
  template <class Value>
  void print(const ReportLine& line, const Value& value) {
    const std::string key = keyOf(line);
    if constexpr (std::is_enum_v<Value>) {
      report_.text(key, line.label, nameOf(tableOf(value), value));
    } else if constexpr (std::is_same_v<Value, std::string>) {
      if (!value.empty()) report_.text(key, line.label, value);
    } else if constexpr (std::is_same_v<Value, bool>) {
      report_.yesNo(key, line.label, value);
    } else if constexpr (std::is_integral_v<Value>) {
      isIn(line, "bytes") ? report_.bytes(key, line.label, std::size_t(value))
                          : report_.count(key, line.label, std::size_t(value));
    } else if constexpr (std::is_same_v<Value, double>) {
      isIn(line, "s") ? report_.seconds(key, line.label, value)
                      : report_.number(key, line.label, value, line.unit);
    } else if (value) {
      print(line, *value);
    }
  }
  static bool isIn(const ReportLine& line, std::string_view unit) { return line.unit == unit; }
  static std::string keyOf(const ReportLine& line) {
    if (*line.key != '\0') return line.key;
    if (isIn(line, "") || isIn(line, "s") || isIn(line, "bytes")) return line.name;
    return fmt::format("{}_{}", line.name, line.unit);
  }
  void further(const char* name) const {
    if (const auto found = further_.find(name); found != further_.end()) found->second();
  }

  Report& report_;
  std::map<std::string_view, std::function<void()>> further_;
};

}  // namespace radiosity::cli
