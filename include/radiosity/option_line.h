// What an option of a stage is, in one line beside its field. Each options struct goes through its
// options in describe(list, options), which calls list(line, field, range): from that come the
// check of ranges, the command line, Python's keywords and the keys of stages
// (src/base/option_list.h).
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace [[gnu::visibility("default")]] radiosity {

/// The finite numbers that an option may be. A bound is within the range (`from`, `to`) or just
/// outside (`above`, `below`); not given, there is none.
struct OptionRange {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  enum class Only { any, even, power_of_two };

  double from = kNone;
  double to = kNone;
  double above = kNone;
  double below = kNone;
  Only only = Only::any;

  bool has(double value) const;
  bool ends() const { return !std::isnan(to) || !std::isnan(below); }
  std::string text() const;  ///< "even, 16 to 4096"; empty: any number
};

/// Whether the key of a stage names an option. A key in a results file stays valid if an option
/// that is new since is there only if it has another value than by default.
enum class InKey { always, if_changed, never };

struct OptionLine {
  const char* name;         ///< of the field; Python's keyword
  const char* option = "";  ///< its other name on the command line and in keys; empty: `name`
  const char* value = "N";  ///< what the command line's help calls the value; "SIZE": bytes, or 2G
  const char* unit = "";
  const char* help = "";  ///< a sentence; empty: the command line does not have the option
  std::array<double, 4> figures{};  ///< for {} in the sentence
  bool used = true;                 ///< false: the other options make it of no effect
  InKey in_key = InKey::always;
  const char* unset = "default";  ///< the word for an empty value
  const char* on = "on";          ///< the words for true and false
  const char* off = "off";

  /// "max-edge" for max_edge.
  std::string optionName() const;
  /// The sentence, with its figures and the range.
  std::string helpText(const OptionRange& range) const;
};

/// Throws InputError "NAME: VALUE is out of range; RANGE".
void requireInRange(const std::string& name, const OptionLine& line, double value,
                    const OptionRange& range);

}  // namespace radiosity
