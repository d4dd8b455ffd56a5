#include "formfactor/rays/sobol.h"

#include "base/hash.h"
#include "formfactor/rays/ray_kernels.h"

namespace radiosity {
namespace {

/// Joe and Kuo's table for one dimension: degree s of the primitive polynomial, its inner
/// coefficients a, and the first s odd numbers m.
struct Polynomial {
  std::uint32_t degree;
  std::uint32_t inner;
  std::array<std::uint32_t, 3> first;
};
constexpr std::array<Polynomial, kDimensions - 1> kPolynomials = {
    {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}}};

std::uint32_t reverseBits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x >> 8) & 0x00ff00ffu);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
  x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
  return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

/// Well-mixed bits of seed and dimension.
std::uint32_t bitsOf(std::uint64_t seed, std::uint64_t dimension) {
  return std::uint32_t(mixed(seed + (dimension + 1) * 0x9e3779b97f4a7c15ull) >> 32);
}

/// Direction numbers v_k = m_k / 2^(k+1) as 32-bit fractions, by Sobol's recurrence
/// m_k = 2 a_1 m_{k-1} ^ ... ^ 2^{s-1} a_{s-1} m_{k-s+1} ^ 2^s m_{k-s} ^ m_{k-s}.
std::array<std::uint32_t, 32> directionNumbers(int dimension) {
  std::array<std::uint32_t, 32> v{};
  if (dimension == 0) {
    for (std::uint32_t k = 0; k < 32; ++k) v[k] = 1u << (31 - k);
    return v;
  }
  const Polynomial& p = kPolynomials[std::size_t(dimension) - 1];
  for (std::uint32_t k = 0; k < 32; ++k) {
    if (k < p.degree) {
      v[k] = p.first[k] << (31 - k);
      continue;
    }
    v[k] = v[k - p.degree] ^ (v[k - p.degree] >> p.degree);
    for (std::uint32_t j = 1; j < p.degree; ++j) {
      if ((p.inner >> (p.degree - 1 - j)) & 1u) v[k] ^= v[k - j];
    }
  }
  return v;
}

}  // namespace

SobolPoints::SobolPoints() {
  for (int d = 0; d < kDimensions; ++d) {
    auto& direction = direction_[std::size_t(d)];
    direction = directionNumbers(d);
    for (std::uint32_t& v : direction) v = reverseBits(v);
    auto& first = first_[std::size_t(d)];
    for (std::uint32_t k = 0; k < kMostPoints; ++k) {
      first[k] = 0;
      for (std::uint32_t bit = 0; bit < 32; ++bit) {
        if ((k >> bit) & 1u) first[k] ^= direction[bit];
      }
    }
  }
}

void SobolPoints::points(std::uint32_t first, std::size_t count, std::uint64_t seed,
                         const PointArrays& out) const {
  const RayKernels kernels = rayKernels();
  for (std::size_t d = 0; d < kDimensions; ++d) {
    // The sequence is linear over XOR: point(a + b) = point(a) ^ point(b) where no bits meet.
    std::uint32_t base = 0;
    for (std::size_t bit = 0; bit < 32; ++bit) {
      if ((first >> bit) & 1u) base ^= direction_[d][bit];
    }
    kernels.scramble(first_[d].data(), count, base, bitsOf(seed, d), out[d]);
  }
}

}  // namespace radiosity
