// One place that prints a figure and records it: every figure on the terminal stands in the
// --report file too, under a stable name.
#pragma once

#include <cstddef>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity::cli {

class Report {
 public:
  /// `quiet`: nothing is printed but warnings of severity loud; all is recorded all the same.
  explicit Report(bool quiet);
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// A heading, and the object of the file that later figures go to.
  void section(const std::string& key, const std::string& title);
  void count(const std::string& key, const std::string& label, std::size_t value);
  /// One that a double holds, rounded: it may be beyond what can be counted.
  void largeCount(const std::string& key, const std::string& label, double value);
  /// `key` ends in the unit where there is one ("area_m2").
  void number(const std::string& key, const std::string& label, double value,
              const std::string& unit = "");
  void bytes(const std::string& key, const std::string& label, std::size_t value);
  void seconds(const std::string& key, const std::string& label, double value);
  void text(const std::string& key, const std::string& label, const std::string& value);
  void yesNo(const std::string& key, const std::string& label, bool value);
  /// One value a band.
  void bands(const std::string& key, const std::string& label, std::span<const double> values,
             const std::string& unit);

  /// Recorded only: too long for a line.
  void series(const std::string& key, std::span<const double> values);

  struct Column {
    std::string key;
    std::string title;
    bool numeric = true;
  };
  /// Rows of cells as they are printed; numeric ones are recorded as numbers. At most `most` rows
  /// are printed, the file has all.
  void table(const std::string& key, const std::vector<Column>& columns,
             const std::vector<std::vector<std::string>>& rows, std::size_t most = 40);

  /// A stage line: "form factors   reused from x.h5". `action`: reused, computed, recomputed,
  /// dropped, kept. `seconds`: by the clock, for the file only; below 0: none.
  void stage(const std::string& key, const std::string& label, const std::string& action,
             const std::string& detail, double seconds = -1);
  /// A line of its own, printed only.
  void line(const std::string& label, const std::string& text);
  /// Loud ones and warnings go to standard error, worst first; many alike are grouped.
  void notes(std::span<const Note> notes);
  /// A file written again replaces what was recorded of it.
  void output(const std::string& path, std::size_t bytes, const std::string& what);

  /// Recorded but not printed while muted.
  void mute(bool on) { muted_ = on; }
  bool muted() const { return muted_ || quiet_; }

  /// The top of the file: command line, exit code, version.
  void fact(const std::string& key, const std::string& value);
  void fact(const std::string& key, const std::vector<std::string>& values);
  void exitCode(int code);
  /// Writes the file, whole or not at all.
  void write(const std::string& path) const;

 private:
  nlohmann::json& here();
  void figure(const std::string& label, const std::string& value) const;

  bool quiet_ = false;
  bool muted_ = false;
  std::string section_;
  std::unique_ptr<nlohmann::json> root_;
};

}  // namespace radiosity::cli
