// Options of stages that were given on the command line, by the lists of their structs
// (radiosity/option_line.h).
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "base/option_list.h"
#include "radiosity/base.h"
#include "radiosity/names.h"

namespace radiosity::cli {

/// Calls check() and prefixes the option's name to an InputError that it throws.
template <class Check>
void nameOption(const std::string& option, const Check& check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(option + ": " + error.what());
  }
}

class GivenOptions {
 public:
  /// `name`: OptionLine::optionName(). `spelled`: as the command line calls it, for messages.
  void add(const std::string& name, const std::string& spelled,
           const std::vector<std::string>& texts) {
    given_[name] = {spelled, texts};
  }
  bool has(const std::string& name) const { return given_.contains(name); }
  /// The option as the command line calls it.
  const std::string& spelled(const std::string& name) const { return given_.at(name).spelled; }

  /// The first of these that was given, as the command line calls it; empty: none.
  std::string firstOf(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      if (has(name)) return spelled(name);
    }
    return {};
  }

  /// The same of a struct's options that are in keys.
  template <class Options>
  std::string firstOf() const {
    const std::vector<std::string> all = allOf<Options>();
    return all.empty() ? std::string() : all.front();
  }
  template <class Options>
  std::vector<std::string> allOf() const {
    std::vector<std::string> all;
    for (const Option& option : optionLines(Options())) {
      const std::string name = option.line.optionName();
      if (option.line.in_key != InKey::never && has(name)) all.push_back(spelled(name));
    }
    return all;
  }

  /// Sets what was given; other fields keep their values. Errors: InputError naming the option.
  template <class Options>
  void applyTo(Options& options) const {
    const auto list = [this](const OptionLine& line, auto& value, const OptionRange& range = {}) {
      const auto found = given_.find(line.optionName());
      if (found == given_.end() || *line.help == '\0') return;
      const auto& [spelled, texts] = found->second;
      using Value = std::remove_cvref_t<decltype(value)>;
      if constexpr (kIsRepeated<Value>) value.clear();
      for (const std::string& text : texts) {
        if (readOption(line, text, value)) continue;
        throw InputError(
            fmt::format("{}: `{}` is not {}", spelled, wrongPart(text), kWanted<Value>));
      }
      requireOption(spelled, line, value, range);
    };
    Options::describe(list, options);
  }

 private:
  template <class Value>
  static constexpr const char* kWanted =
      std::is_integral_v<Value>                    ? "a whole number from 0 on"
      : std::is_same_v<Value, std::vector<double>> ? "a number; separate several by commas alone"
                                                   : "a number";
  /// Words were checked when they were parsed: the text is a number, or several.
  static std::string wrongPart(const std::string& text) {
    for (const std::string_view part : splitAt(text, ',')) {
      if (!parseNumber(part)) return std::string(part);
    }
    return text;
  }
  struct Given {
    std::string spelled;
    std::vector<std::string> texts;  ///< one, but for options that may be repeated
  };
  std::map<std::string, Given> given_;
};

}  // namespace radiosity::cli
