// Keyword arguments that become options.
#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>

#include "radiosity/names.h"

namespace radiosity::python {

namespace py = pybind11;

/// Takes the keyword arguments of a call one by one; None leaves what there is.
class Options {
 public:
  explicit Options(py::dict given) : given_(std::move(given)) {}

  template <class Value>
  void operator()(const char* name, Value& value) const {
    if (has(name)) value = given_[name].template cast<Value>();
  }
  template <class Enum, std::size_t N>
  void choice(const char* name, const NameTable<Enum, N>& table, Enum& value) const {
    if (!has(name)) return;
    const std::string word = py::str(given_[name]);
    const std::optional<Enum> known = named(table, word);
    if (!known) {
      throw InputError(
          fmt::format("{}: '{}' is not one of {}", name, word, fmt::join(namesIn(table), ", ")));
    }
    value = *known;
  }
  bool has(const char* name) const { return given_.contains(name) && !given_[name].is_none(); }

 private:
  py::dict given_;
};

}  // namespace radiosity::python
