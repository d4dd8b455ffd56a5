// Converts keyword arguments to options.
#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "radiosity/names.h"
#include "radiosity/option_line.h"
#include "text.h"

namespace radiosity::python {

namespace py = pybind11;

/// InputError "NAME: is VALUE of type T; give WANTED".
[[noreturn]] void refuse(const std::string& name, const py::handle& given,
                         const std::string& wanted);

/// The Python int for an integer of any type (int, numpy's, a float without a fraction); null for
/// other values.
py::object wholeNumber(const py::handle& given);

/// The words for values of this type.
template <class Value>
inline constexpr const char* kWanted = "a number";
template <>
inline constexpr const char* kWanted<bool> = "True or False";
template <>
inline constexpr const char* kWanted<std::string> = "text";
template <>
inline constexpr const char* kWanted<std::vector<std::string>> = "a list of texts";
template <>
inline constexpr const char* kWanted<std::vector<double>> = "a list of numbers";
template <>
inline constexpr const char* kWanted<std::array<double, 3>> = "three numbers";

/// Converts the value that a caller gave for `name`. Errors: InputError if it has another type.
template <class Value>
Value valueOf(const std::string& name, const py::handle& given) {
  try {
    return given.cast<Value>();
  } catch (const py::cast_error&) {
    refuse(name, given, kWanted<Value>);
  }
}
template <std::integral Value>
  requires(!std::same_as<Value, bool>)
Value valueOf(const std::string& name, const py::handle& given) {
  const py::object whole = wholeNumber(given);
  if (!whole) refuse(name, given, "a whole number");
  try {
    return whole.cast<Value>();
  } catch (const py::cast_error&) {
    using Limits = std::numeric_limits<Value>;
    refuse(name, given, fmt::format("a whole number, {} to {}", Limits::min(), Limits::max()));
  }
}

/// Takes the keyword arguments of a call one by one; None leaves an option unchanged.
class KeywordOptions {
 public:
  /// `of`: the owner of the arguments in messages ("camera"); empty: the call itself.
  explicit KeywordOptions(py::dict given, std::string of = {})
      : given_(std::move(given)), of_(std::move(of)) {}

  template <class Value>
  void operator()(const char* name, Value& value) const {
    if (has(name)) value = valueOf<Value>(called(name), given_[name]);
  }
  template <class Value>
  void operator()(const char* name, std::optional<Value>& value) const {
    if (has(name)) (*this)(name, value.emplace());
  }
  template <class Enum>
    requires std::is_enum_v<Enum>
  void operator()(const char* name, Enum& value) const {
    if (!has(name)) return;
    const auto& table = tableOf(value);
    const std::string word = py::str(given_[name]);
    const std::optional<Enum> known = named(table, word);
    if (!known) {
      throw InputError(
          fmt::format("{}: '{}' is not one of {}", name, word, fmt::join(namesIn(table), ", ")));
    }
    value = *known;
  }
  /// As an element of an options struct's list.
  template <class Value>
  void operator()(const OptionLine& line, Value& value, const OptionRange& = {}) const {
    (*this)(line.name, value);
  }
  bool has(const char* name) const { return given_.contains(name) && !given_[name].is_none(); }

 private:
  std::string called(const char* name) const { return of_.empty() ? name : of_ + " " + name; }

  py::dict given_;
  std::string of_;
};

/// A value as Python has it: a word for an enum, None for none.
template <class Value>
py::object asPython(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return py::str(nameOf(tableOf(value), value));
  } else {
    return py::cast(value);
  }
}
template <class Value>
py::object asPython(const std::optional<Value>& value) {
  return value ? asPython(*value) : py::none();
}

/// A dict an option of a struct: its name, value and help, and whether it is used beside the
/// others.
template <class Options>
py::list described(const Options& options) {
  py::list all;
  const auto list = [&](const OptionLine& line, const auto& value, const OptionRange& range = {}) {
    py::dict option;
    option["name"] = line.name;
    option["value"] = asPython(value);
    option["help"] = line.helpText(range);
    option["used"] = line.used;
    all.append(option);
  };
  Options::describe(list, options);
  return all;
}

/// The options of a struct from the arguments of a call, in range.
template <class Options>
Options optionsFrom(const py::dict& given) {
  Options options;
  const KeywordOptions take(given);
  Options::describe(take, options);
  options.validate();
  return options;
}

}  // namespace radiosity::python
