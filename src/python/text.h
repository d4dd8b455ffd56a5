// Texts of files between C++ and Python. Names in files are bytes, mostly but not always of UTF-8.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace radiosity::python {

/// Text in which bytes that are not of UTF-8 become "\xdf": it can be printed.
inline pybind11::str printable(const std::string& text) {
  return pybind11::reinterpret_steal<pybind11::str>(
      PyUnicode_DecodeUTF8(text.data(), Py_ssize_t(text.size()), "backslashreplace"));
}

}  // namespace radiosity::python

namespace pybind11::detail {

/// Replaces pybind11's conversion, which throws for other bytes than UTF-8. Here they become lone
/// surrogates, and surrogates become these bytes again (PEP 383), so that names from a file name
/// the same things when they are given back.
template <>
struct type_caster<std::string> {
  PYBIND11_TYPE_CASTER(std::string, const_name("str"));

  bool load(handle given, bool /*convert*/) {
    if (!given) return false;
    object bytes = reinterpret_borrow<object>(given);
    if (PyUnicode_Check(given.ptr()) != 0) {
      bytes = reinterpret_steal<object>(
          PyUnicode_AsEncodedString(given.ptr(), "utf-8", "surrogateescape"));
    }
    if (!bytes || PyBytes_Check(bytes.ptr()) == 0) {
      PyErr_Clear();
      return false;
    }
    value.assign(PyBytes_AS_STRING(bytes.ptr()), std::size_t(PyBytes_GET_SIZE(bytes.ptr())));
    return true;
  }

  static handle cast(const std::string& text, return_value_policy /*policy*/, handle /*parent*/) {
    PyObject* made = PyUnicode_DecodeUTF8(text.data(), Py_ssize_t(text.size()), "surrogateescape");
    if (made == nullptr) throw error_already_set();
    return made;
  }
};

}  // namespace pybind11::detail
