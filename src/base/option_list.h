// Goes through the options of a struct (radiosity/option_line.h): their values as text and back,
// and the check of their ranges. Who uses it for enums includes radiosity/names.h.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/parse.h"
#include "radiosity/base.h"
#include "radiosity/option_line.h"

namespace radiosity {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
/// Given several times, it is the list of all.
template <class T>
inline constexpr bool kIsRepeated = std::is_same_v<T, std::vector<std::string>>;

/// A value with a text of its own.
template <class T>
inline constexpr bool kHasText = requires(T value) {
  { value.optionText() } -> std::same_as<std::string>;
  { value.readOption("") } -> std::same_as<bool>;
};

template <class T>
std::string optionText(const OptionLine& line, const T& value) {
  if constexpr (kHasText<T>) {
    return value.optionText();
  } else if constexpr (std::is_same_v<T, bool>) {
    return value ? line.on : line.off;
  } else if constexpr (std::is_enum_v<T>) {
    return nameOf(tableOf(value), value);
  } else if constexpr (kIsOptional<T>) {
    return value ? optionText(line, *value) : line.unset;
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    return value.empty() ? line.unset : fmt::format("{}", fmt::join(value, ","));
  } else if constexpr (std::is_same_v<T, Vec3>) {
    return fmt::format("{},{},{}", value.x, value.y, value.z);
  } else if constexpr (kIsRepeated<T>) {
    return fmt::format("{}", fmt::join(value, ","));
  } else {
    return fmt::format("{}", value);
  }
}

/// Whether the text is a value of the option, which it then becomes.
template <class T>
bool readOption(const OptionLine& line, std::string_view text, T& value) {
  if constexpr (kHasText<T>) {
    return value.readOption(text);
  } else if constexpr (std::is_same_v<T, bool>) {
    value = text == line.on;
    return value || text == line.off;
  } else if constexpr (std::is_enum_v<T>) {
    const std::optional<T> found = named(tableOf(value), text);
    if (found) value = *found;
    return found.has_value();
  } else if constexpr (kIsOptional<T>) {
    typename T::value_type inner{};
    const bool unset = text == line.unset;
    if (!unset && !readOption(line, text, inner)) return false;
    value = unset ? T() : T(inner);
    return true;
  } else if constexpr (std::is_same_v<T, std::vector<double>>) {
    value.clear();
    if (text == line.unset) return true;
    for (const std::string_view word : splitAt(text, ',')) {
      const std::optional<double> number = parseNumber(word);
      if (!number) return false;
      value.push_back(*number);
    }
    return true;
  } else if constexpr (std::is_same_v<T, Vec3>) {
    std::vector<double> numbers;
    if (!readOption(line, text, numbers) || numbers.size() != 3) return false;
    value = {numbers[0], numbers[1], numbers[2]};
    return true;
  } else if constexpr (std::is_same_v<T, std::string>) {
    value = text;
    return true;
  } else if constexpr (kIsRepeated<T>) {
    value.emplace_back(text);
    return true;
  } else {
    T parsed{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    if (error != std::errc() || end != text.data() + text.size()) return false;
    value = parsed;
    return true;
  }
}

/// Throws InputError if a number is out of range.
template <class T>
void requireOption(const std::string& name, const OptionLine& line, const T& value,
                   const OptionRange& range) {
  if constexpr (kIsOptional<T>) {
    if (value) requireOption(name, line, *value, range);
  } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
    requireInRange(name, line, double(value), range);
  }
}

/// Throws InputError naming the field and its range.
template <class Options>
void requireRanges(const Options& options) {
  const auto list = [](const OptionLine& line, const auto& value, const OptionRange& range = {}) {
    requireOption(line.name, line, value, range);
  };
  Options::describe(list, options);
}

/// An option, with its value as text.
struct Option {
  OptionLine line;
  OptionRange range;
  std::string text;
  std::vector<std::string> words;  ///< that the text may be; empty: it is a number, or any text
  bool repeated = false;
};

/// Whether it is turned on and off by its name alone: the line gives it no value.
inline bool isFlag(const Option& option) {
  return option.words == std::vector<std::string>{"on", "off"} &&
         option.line.value == std::string_view(OptionLine().value);
}

template <class T>
std::vector<std::string> optionWords(const OptionLine& line, const T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    return {line.on, line.off};
  } else if constexpr (std::is_enum_v<T>) {
    return namesIn(tableOf(value));
  } else if constexpr (kIsOptional<T>) {
    std::vector<std::string> words = optionWords(line, typename T::value_type());
    if (!words.empty()) words.insert(words.begin(), line.unset);
    return words;
  } else {
    return {};
  }
}

template <class Options>
std::vector<Option> optionLines(const Options& options) {
  std::vector<Option> all;
  const auto list = [&all](const OptionLine& line, const auto& value,
                           const OptionRange& range = {}) {
    all.push_back({line, range, optionText(line, value), optionWords(line, value),
                   kIsRepeated<std::remove_cvref_t<decltype(value)>>});
  };
  Options::describe(list, options);
  return all;
}

/// Those that differ from the defaults.
template <class Options>
std::vector<Option> changedOptions(const Options& options) {
  const std::vector<Option> usual = optionLines(Options());
  std::vector<Option> changed;
  for (std::size_t k = 0; const Option& option : optionLines(options)) {
    if (option.text != usual[k++].text) changed.push_back(option);
  }
  return changed;
}

/// "name=value name=value ...": the options that a result depends on, as keys have them.
template <class Options>
std::string keyText(const Options& options) {
  const std::vector<Option> usual = optionLines(Options());
  std::string text;
  for (std::size_t k = 0; const Option& option : optionLines(options)) {
    const bool is_usual = option.text == usual[k++].text;
    const InKey in_key = option.line.in_key;
    if (!option.line.used || in_key == InKey::never) continue;
    if (in_key == InKey::if_changed && is_usual) continue;
    text += (text.empty() ? "" : " ") + option.line.optionName() + "=" + option.text;
  }
  return text;
}

/// The options in such a text; defaults for those that it does not name.
template <class Options>
Options optionsIn(std::string_view text) {
  Options options;
  const auto list = [text](const OptionLine& line, auto& value, const OptionRange& = {}) {
    for (const std::string_view pair : splitAt(text, ' ')) {
      const std::string name = line.optionName() + "=";
      if (pair.starts_with(name)) readOption(line, pair.substr(name.size()), value);
    }
  };
  Options::describe(list, options);
  return options;
}

}  // namespace radiosity
