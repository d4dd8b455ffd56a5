// Errors of formulas for pairs with nothing in between, of random shapes and placements.
#pragma once

#include <cstddef>
#include <cstdint>

namespace radiosity::bench {

/// Of `pairs` pairs of each shape (tests/formfactor/element_pairs.h), against contour integrals in
/// long double; errors are relative:
///
///     rule k R skew error      k: -1: the series, 0 to 4: the rules of far_rules.h
///     lambert n ratio error    Lambert's formula over n x n points
///     eye h_over_r height error   kernels for far targets, from one point; height: the lesser one
///                              of either's middle above the other's plane, in h
///     digits level error       tanh-sinh quadrature of a logarithm at the end
///
/// R and skew: see far_kernels.h. Errors below what the reference knows are left out.
void sampleShapes(std::size_t pairs, std::uint64_t seed);

}  // namespace radiosity::bench
