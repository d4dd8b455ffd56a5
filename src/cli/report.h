// Prints figures and records them: every figure on the terminal is also in the --report file, under
// a stable name.
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
  /// `quiet`: prints only notes of severity loud, but records everything.
  explicit Report(bool quiet);
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// A heading, and the object in the file for the figures that follow.
  void section(const std::string& key, const std::string& title);
  void count(const std::string& key, const std::string& label, std::size_t value);
  /// A count in a double, rounded: it may be too large for an integer.
  void largeCount(const std::string& key, const std::string& label, double value);
  /// `key` ends in the unit, if there is one ("area_m2").
  void number(const std::string& key, const std::string& label, double value,
              const std::string& unit = "");
  void bytes(const std::string& key, const std::string& label, std::size_t value);
  void seconds(const std::string& key, const std::string& label, double value);
  void text(const std::string& key, const std::string& label, const std::string& value);
  void yesNo(const std::string& key, const std::string& label, bool value);
  /// One value for each band, or a place. `digits`: that are printed of each.
  void bands(const std::string& key, const std::string& label, std::span<const double> values,
             const std::string& unit, int digits = 6);

  /// A series of values, which is only recorded: it is too long for a line.
  void series(const std::string& key, std::span<const double> values);

  struct Column {
    std::string key;
    std::string title;
    bool numeric = true;
  };
  /// A table of printed cells; numeric ones are recorded as numbers. Prints at most `most` rows;
  /// the file has all.
  void table(const std::string& key, const std::vector<Column>& columns,
             const std::vector<std::vector<std::string>>& rows, std::size_t most = 40);

  /// A stage line: "form factors   reused from x.h5". `action`: reused, computed, recomputed,
  /// dropped, kept. `seconds`: by the clock, for the file only; below 0: none.
  void stage(const std::string& key, const std::string& label, const std::string& action,
             const std::string& detail, double seconds = -1);
  /// A line that is only printed.
  void line(const std::string& label, const std::string& text);
  /// Prints notes. Loud ones and warnings go to standard error, worst first; similar ones are
  /// grouped.
  void notes(std::span<const Note> notes);
  /// Records an output file. A file that is written again replaces its record.
  void output(const std::string& path, std::size_t bytes, const std::string& what);

  /// While muted, figures are recorded but not printed.
  void mute(bool on) { muted_ = on; }
  bool muted() const { return muted_ || quiet_; }

  /// A fact at the top of the file: command line, exit code, version.
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
