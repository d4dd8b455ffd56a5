// A safe layer over HDF5's C API: handles that close themselves, errors as one line, no printing.
#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "radiosity/base.h"

namespace radiosity::h5 {

/// Owns one HDF5 identifier.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { close(); }
  hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }
  /// Closes the identifier; false if HDF5 could not (a file that could not be flushed).
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Stops HDF5 from printing its error stack while this object lives. Afterwards HDF5 prints again,
/// unless it met damage: then HDF5 1.10 has leaked objects and would complain about them on stderr
/// when the process ends, so it stays silent.
class Silence {
 public:
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Silence() {
    if (!for_good_) H5Eset_auto2(H5E_DEFAULT, function_, data_);
  }
  void keepForGood() { for_good_ = true; }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
  bool for_good_ = false;
};

/// The innermost reason on HDF5's error stack, e.g. "No space left on device". Call it at once: the
/// next call of HDF5, even a close, empties the stack.
std::string lastError();

/// The kinds of numbers in a file.
enum class Number { u8, i32, u32, i64, u64, f32, f64 };

hid_t typeOf(Number number);
std::size_t sizeOf(Number number);
/// The name of a kind in messages: "32-bit float".
const char* nameOf(Number number);

template <class T>
constexpr Number numberOf();
template <>
constexpr Number numberOf<std::uint8_t>() {
  return Number::u8;
}
template <>
constexpr Number numberOf<std::int32_t>() {
  return Number::i32;
}
template <>
constexpr Number numberOf<std::uint32_t>() {
  return Number::u32;
}
template <>
constexpr Number numberOf<std::int64_t>() {
  return Number::i64;
}
template <>
constexpr Number numberOf<std::uint64_t>() {
  return Number::u64;
}
template <>
constexpr Number numberOf<float>() {
  return Number::f32;
}
template <>
constexpr Number numberOf<double>() {
  return Number::f64;
}

/// The layout of a vector's element in memory: numbers of one kind, a row of the dataset.
template <class T>
struct Element {
  using Scalar = T;
  static constexpr std::size_t kColumns = 0;  ///< 0: the dataset has one dimension
};
template <>
struct Element<Vec2> {
  using Scalar = double;
  static constexpr std::size_t kColumns = 2;
};
template <>
struct Element<Vec3> {
  using Scalar = double;
  static constexpr std::size_t kColumns = 3;
};
template <std::size_t N>
struct Element<std::array<Index, N>> {
  using Scalar = Index;
  static constexpr std::size_t kColumns = N;
};

template <class T>
inline constexpr std::size_t kNumbersIn = Element<T>::kColumns == 0 ? 1 : Element<T>::kColumns;

/// Rows x columns of one kind of number; `columns` 0: one dimension.
struct Shape {
  Number number = Number::f64;
  std::size_t rows = 0;
  std::size_t columns = 0;

  std::size_t perRow() const { return columns == 0 ? 1 : columns; }
  std::size_t count() const { return rows * perRow(); }
  std::size_t bytes() const { return count() * sizeOf(number); }
};

/// Datasets up to this many bytes are stored in their object header, whose checksum HDF5 tests.
inline constexpr std::size_t kCompactBytes = 4096;
/// Other datasets have chunks of about this many bytes, each with its own checksum. By default h5py
/// and other readers cache a megabyte.
inline constexpr std::size_t kChunkBytes = std::size_t(1) << 20;

/// The rows of a chunk. All chunks are nearly equal, so that the last one wastes almost nothing.
std::size_t chunkRows(const Shape& shape);

}  // namespace radiosity::h5
