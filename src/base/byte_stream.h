// Values as a row of bytes, in the order of this machine, and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace radiosity {

class ByteWriter {
 public:
  template <class Value>
  void put(const Value& value) {
    static_assert(std::is_trivially_copyable_v<Value>);
    append(&value, sizeof value);
  }
  /// The length, then the values.
  template <class Value>
  void putArray(std::span<const Value> values) {
    static_assert(std::is_trivially_copyable_v<Value>);
    putVarint(values.size());
    append(values.data(), values.size_bytes());
  }
  /// Seven bits a byte, the low ones first: small numbers are short.
  void putVarint(std::uint64_t value) {
    constexpr std::uint64_t kMore = 0x80;
    for (; value >= kMore; value >>= 7U) bytes_.push_back(std::byte(value | kMore));
    bytes_.push_back(std::byte(value));
  }
  std::span<const std::byte> bytes() const { return bytes_; }
  /// The bytes, which leaves none.
  std::vector<std::byte> take() { return std::exchange(bytes_, {}); }

 private:
  void append(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  std::vector<std::byte> bytes_;
};

/// Reads values back in the order in which they were put. If the bytes end too early, it returns
/// zeros and reads nothing: ask isWhole() before you use the values.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class Value>
  Value get() {
    static_assert(std::is_trivially_copyable_v<Value>);
    Value value{};
    take(&value, sizeof value);
    return value;
  }
  template <class Value>
  std::vector<Value> getArray() {
    static_assert(std::is_trivially_copyable_v<Value>);
    const std::uint64_t size = getVarint();
    if (size > rest_.size() / sizeof(Value)) {
      short_ = true;
      return {};
    }
    std::vector<Value> values(size);
    take(values.data(), size * sizeof(Value));
    return values;
  }
  std::uint64_t getVarint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const auto byte = get<std::uint8_t>();
      value |= std::uint64_t(byte & 0x7fU) << shift;
      if ((byte & 0x80U) == 0) return value;
    }
    short_ = true;
    return 0;
  }
  /// Whether all bytes were read, and nothing beyond.
  bool isWhole() const { return !short_ && rest_.empty(); }
  /// The number of bytes that are not read yet: no array is longer.
  std::size_t left() const { return rest_.size(); }

 private:
  void take(void* data, std::size_t size) {
    if (size > rest_.size()) {
      short_ = true;
      return;
    }
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::span<const std::byte> rest_;
  bool short_ = false;
};

}  // namespace radiosity
