// HDF5's C API made safe: handles that close themselves, errors as one line, no printing.
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
  /// False where HDF5 could not close it (a file that could not be flushed).
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// While it lives HDF5 keeps its error stack to itself; afterwards it does what it did before,
/// unless it met damage: then HDF5 1.10 has leaked what it held and would complain about that on
/// stderr when the process ends, so it stays silent.
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

/// The innermost reason on HDF5's error stack, e.g. "No space left on device". To be asked at once:
/// the next call of HDF5, be it a close, empties the stack.
std::string lastError();

/// The numbers a file holds.
enum class Number { u8, i32, u32, i64, u64, f32, f64 };

hid_t typeOf(Number number);
std::size_t sizeOf(Number number);
/// In words, for messages: "32-bit float".
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

/// How an element of a vector lies in memory: so many numbers of one kind, a row of the dataset.
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

/// Datasets up to this many bytes lie in their object header, which HDF5 checks by itself.
inline constexpr std::size_t kCompactBytes = 4096;
/// Others lie in chunks of about this many bytes, each with its own checksum. A megabyte is what
/// h5py and other readers cache by default.
inline constexpr std::size_t kChunkBytes = std::size_t(1) << 20;

/// Rows of a chunk: all chunks nearly equal, so that the last one wastes next to nothing.
std::size_t chunkRows(const Shape& shape);

}  // namespace radiosity::h5
