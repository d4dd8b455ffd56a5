// Arrays between C++ and numpy.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <span>
#include <vector>

#include "radiosity/base.h"

namespace radiosity::python {

namespace py = pybind11;

/// A read-only view of values in memory, without a copy. It keeps `owner`, the Python object that
/// has them, alive.
template <class T>
py::array view(const T* values, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array array(py::dtype::of<T>(), std::move(shape), values, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}
template <class T>
py::array view(const std::vector<T>& values, const py::object& owner) {
  return view(values.data(), {py::ssize_t(values.size())}, owner);
}
inline py::array view(const std::vector<Vec3>& values, const py::object& owner) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return view(reinterpret_cast<const double*>(values.data()), {py::ssize_t(values.size()), 3},
              owner);
}
inline py::array view(const std::vector<std::array<Index, 3>>& values, const py::object& owner) {
  return view(reinterpret_cast<const Index*>(values.data()), {py::ssize_t(values.size()), 3},
              owner);
}
/// N * bands values as (N, bands).
template <class T>
py::array rows(const std::vector<T>& values, int bands, const py::object& owner) {
  return view(values.data(), {py::ssize_t(values.size()) / bands, bands}, owner);
}

/// A single vector as an argument or result in Python.
using Triple = std::array<double, 3>;
inline Vec3 vec(const Triple& t) { return {t[0], t[1], t[2]}; }
inline Triple triple(const Vec3& v) { return {v.x, v.y, v.z}; }

/// A new array that takes over the values without a copy.
template <class T>
py::array taken(std::vector<T>&& values) {
  auto* kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array(py::dtype::of<T>(), {py::ssize_t(kept->size())}, kept->data(), owner);
}

/// A contiguous array of one type; the package's functions have converted it.
template <class T>
using Array = py::array_t<T, py::array::c_style>;

template <class T>
std::span<const T> spanOf(const Array<T>& array) {
  return {array.data(), std::size_t(array.size())};
}
template <class T>
std::vector<T> vectorOf(const Array<T>& array) {
  return {array.data(), array.data() + array.size()};
}
/// (n, 3) numbers as n vectors.
inline std::span<const Vec3> vectorsOf(const Array<double>& array) {
  return {reinterpret_cast<const Vec3*>(array.data()), std::size_t(array.size()) / 3};
}

}  // namespace radiosity::python
