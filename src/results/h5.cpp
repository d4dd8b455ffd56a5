#include "results/h5.h"

#include <string_view>

namespace radiosity::h5 {

namespace {

struct Innermost {
  std::string text;
};

herr_t keepInnermost(unsigned /*depth*/, const H5E_error2_t* error, void* data) {
  // We walk downward, so the last call has the place of the error.
  if (error->desc != nullptr) static_cast<Innermost*>(data)->text = error->desc;
  return 0;
}

}  // namespace

std::string lastError() {
  Innermost innermost;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keepInnermost, &innermost);
  // HDF5 describes a failed system call with time, descriptor and buffer; we only show its message.
  constexpr std::string_view kMessage = "error message = '";
  const std::size_t begin = innermost.text.find(kMessage);
  if (begin != std::string::npos) {
    const std::size_t from = begin + kMessage.size();
    return innermost.text.substr(from, innermost.text.find('\'', from) - from);
  }
  return innermost.text.empty() ? "unknown reason" : innermost.text;
}

hid_t typeOf(Number number) {
  switch (number) {
    case Number::u8:
      return H5T_NATIVE_UINT8;
    case Number::i32:
      return H5T_NATIVE_INT32;
    case Number::u32:
      return H5T_NATIVE_UINT32;
    case Number::i64:
      return H5T_NATIVE_INT64;
    case Number::u64:
      return H5T_NATIVE_UINT64;
    case Number::f32:
      return H5T_NATIVE_FLOAT;
    case Number::f64:
      break;
  }
  return H5T_NATIVE_DOUBLE;
}

std::size_t sizeOf(Number number) {
  switch (number) {
    case Number::u8:
      return 1;
    case Number::i32:
    case Number::u32:
    case Number::f32:
      return 4;
    case Number::i64:
    case Number::u64:
    case Number::f64:
      break;
  }
  return 8;
}

const char* nameOf(Number number) {
  switch (number) {
    case Number::u8:
      return "8-bit unsigned";
    case Number::i32:
      return "32-bit integer";
    case Number::u32:
      return "32-bit unsigned";
    case Number::i64:
      return "64-bit integer";
    case Number::u64:
      return "64-bit unsigned";
    case Number::f32:
      return "32-bit float";
    case Number::f64:
      break;
  }
  return "64-bit float";
}

std::size_t chunkRows(const Shape& shape) {
  const std::size_t row_bytes = shape.perRow() * sizeOf(shape.number);
  const std::size_t most = kChunkBytes / row_bytes > 0 ? kChunkBytes / row_bytes : 1;
  const std::size_t chunks = (shape.rows + most - 1) / most;
  return chunks == 0 ? 1 : (shape.rows + chunks - 1) / chunks;
}

}  // namespace radiosity::h5
