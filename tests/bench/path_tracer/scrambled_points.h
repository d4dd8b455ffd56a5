// Points in the unit square for the dimensions of a path, two at a time.
#pragma once

#include <cstdint>

#include "radiosity/base.h"

namespace radiosity::bench {

/// Pair after pair of the coordinates of one of a set's points. Each pair takes the Sobol points of
/// two dimensions, scrambled and shuffled anew (Burley, "Practical Hash-based Owen Scrambling",
/// 2020): 2^m points of a set fill every pair of dimensions evenly, sets of other seeds are
/// independent of it.
class ScrambledPoints {
 public:
  ScrambledPoints(std::uint32_t index, std::uint64_t seed) : index_(index), seed_(seed) {}

  Vec2 next() {
    const std::uint64_t bits = mixed(seed_ + 0x9e3779b97f4a7c15ull * ++pair_);
    const std::uint32_t i = scrambled(index_, std::uint32_t(bits));
    const std::uint64_t more = mixed(bits);
    return {unit(scrambled(reversed(i), std::uint32_t(more))),
            unit(scrambled(second(i), std::uint32_t(more >> 32)))};
  }

 private:
  static std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
  }
  static std::uint32_t reversed(std::uint32_t x) {
    x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    return __builtin_bswap32(x);
  }
  /// Owen's scrambling, by a hash in which low bits move high ones alone (Laine & Karras).
  static std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reversed(x);
  }
  static std::uint32_t second(std::uint32_t i) {
    std::uint32_t sum = 0;
    for (std::uint32_t v = 1u << 31; i != 0; i >>= 1, v ^= v >> 1) {
      if ((i & 1) != 0) sum ^= v;
    }
    return sum;
  }
  static double unit(std::uint32_t x) { return (double(x) + 0.5) * 0x1p-32; }

  std::uint32_t index_;
  std::uint64_t seed_;
  std::uint64_t pair_ = 0;
};

}  // namespace radiosity::bench
