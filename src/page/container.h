// The scene's data in a page: a header, and named arrays whose places are in the header.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace radiosity::page {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie");

/// "RADPAGE1", the header's length (32 bits), four zeros; the header, JSON in UTF-8 padded by
/// spaces; the arrays. Header and arrays begin at multiples of 8 bytes.
class Container {
 public:
  using Json = nlohmann::ordered_json;

  /// The header without "arrays".
  Json& header() { return header_; }

  /// Adds an array. Errors: RunError naming the array if a value is not finite.
  void add(const std::string& name, std::span<const float> values) {
    requireFinite(name, values);
    append(name, "f32", values);
  }
  void add(const std::string& name, std::span<const std::uint32_t> values) {
    append(name, "u32", values);
  }
  void add(const std::string& name, std::span<const std::uint16_t> values) {
    append(name, "u16", values);
  }
  void add(const std::string& name, std::span<const std::uint8_t> values) {
    append(name, "u8", values);
  }

  std::vector<std::byte> bytes() const;

 private:
  template <class Value>
  void append(const std::string& name, const char* type, std::span<const Value> values) {
    arrays_.push_back({name, type, data_.size(), values.size()});
    const auto bytes = std::as_bytes(values);
    data_.insert(data_.end(), bytes.begin(), bytes.end());
    data_.resize(padded(data_.size()));
  }
  static void requireFinite(const std::string& name, std::span<const float> values);
  static std::size_t padded(std::size_t size) { return (size + 7) / 8 * 8; }
  std::string headerText(std::size_t first_array) const;

  struct Array {
    std::string name;
    const char* type;
    std::size_t begin;  ///< in data_
    std::size_t length;
  };
  Json header_;
  std::vector<Array> arrays_;
  std::vector<std::byte> data_;
};

}  // namespace radiosity::page
