// Identities for caching and for seeds: FNV-1a, 64 bits. Not for security.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

namespace radiosity {

/// Bits that all depend on all of the given ones (the finaliser of SplitMix64, Steele, Lea & Flood
/// 2014).
constexpr std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
  return bits ^ (bits >> 31U);
}

class Hash {
 public:
  void bytes(const void* data, std::size_t size) {
    const auto* p = static_cast<const unsigned char*>(data);
    for (std::size_t k = 0; k < size; ++k) state_ = (state_ ^ p[k]) * 0x100000001b3ull;
  }
  void text(std::string_view s) {
    const std::uint64_t length = s.size();
    bytes(&length, sizeof length);
    bytes(s.data(), s.size());
  }
  /// The raw bytes of a contiguous container of trivially copyable values, and its length.
  template <class Container>
  void array(const Container& values) {
    const std::uint64_t length = values.size();
    bytes(&length, sizeof length);
    bytes(values.data(), values.size() * sizeof(*values.data()));
  }
  std::uint64_t value() const { return state_; }
  std::string hex() const {
    char out[17];
    std::snprintf(out, sizeof out, "%016llx", static_cast<unsigned long long>(state_));
    return out;
  }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

/// A checksum of bytes, eight at a time. It always detects a change of one byte, and misses a
/// change of more with a probability of 2^-64. Each step is invertible, as in FNV-1a, and the
/// rotation brings high bits down.
inline std::uint64_t checksumOf(const void* data, std::size_t size) {
  const auto* p = static_cast<const unsigned char*>(data);
  std::uint64_t state = 0xcbf29ce484222325ull ^ size;
  const auto step = [&](std::uint64_t word) {
    state = (state ^ word) * 0x9e3779b97f4a7c15ull;
    state = (state << 29U) | (state >> 35U);
  };
  std::uint64_t word = 0;
  for (; size >= sizeof word; size -= sizeof word, p += sizeof word) {
    std::memcpy(&word, p, sizeof word);
    step(word);
  }
  word = 0;
  std::memcpy(&word, p, size);
  step(word);
  return state ^ (state >> 32U);
}

}  // namespace radiosity
