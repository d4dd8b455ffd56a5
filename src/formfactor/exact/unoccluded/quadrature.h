// Quadrature rules on [-1, 1].
#pragma once

#include <span>

namespace radiosity {

struct Node {
  double x;       ///< in (-1, 1)
  double weight;  ///< of all: 2
  double gap;     ///< distance from the nearer end, to full relative accuracy
};

inline constexpr int kMostGaussNodes = 24;
/// Gauss-Legendre, exact for polynomials of degree 2n - 1; n from 1 to kMostGaussNodes.
std::span<const Node> gaussLegendre(int n);

/// Tanh-sinh (Takahasi & Mori 1974) with steps of 2^-level, level 0 to kFinestTanhSinh: converges
/// exponentially also where the integrand is singular at the ends, if integrable.
inline constexpr int kFinestTanhSinh = 5;
std::span<const Node> tanhSinh(int level);

}  // namespace radiosity
