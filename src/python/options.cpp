#include "options.h"

#include <cmath>

namespace radiosity::python {
namespace {

/// The text of a value on one line.
std::string shown(const py::handle& given) {
  constexpr std::size_t kLongest = 60;  // characters
  const py::str line = py::str(" ").attr("join")(py::repr(given).attr("split")());
  if (py::len(line) <= kLongest) return line;
  return std::string(py::str(line[py::slice(0, kLongest, 1)])) + "...";
}

}  // namespace

void refuse(const std::string& name, const py::handle& given, const std::string& wanted) {
  const std::string type = py::str(py::type::handle_of(given).attr("__name__"));
  throw InputError(fmt::format("{}: is {} of type {}; give {}", name, shown(given), type, wanted));
}

py::object wholeNumber(const py::handle& given) {
  PyObject* whole = PyNumber_Index(given.ptr());
  if (whole == nullptr && PyNumber_Check(given.ptr()) != 0) {
    PyErr_Clear();
    const double value = PyFloat_AsDouble(given.ptr());
    if (PyErr_Occurred() == nullptr && std::floor(value) == value && std::isfinite(value)) {
      whole = PyLong_FromDouble(value);
    }
  }
  PyErr_Clear();
  return py::reinterpret_steal<py::object>(whole);
}

}  // namespace radiosity::python
