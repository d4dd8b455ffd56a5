// Irradiance of clusters beyond that of their matrix, as a source term of the second solution.
#pragma once

#include <span>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity {

/// Area times value, summed over rows of a band; `values`: N * bands, row-major.
double powerOf(std::span<const double> area, std::span<const double> values, int bands, int band);

/// True if any row sees the sky or backs.
bool seesOut(const FormFactors& factors);

/// Returns `more`, raised where `irradiance` plus `more` would be negative. If no row sees the sky
/// or backs, it then scales that sum in each band, so that `more` adds no power. Both arrays: N *
/// bands, row-major.
std::vector<double> balanced(const FormFactors& factors, std::span<const double> more,
                             std::span<const double> irradiance, int bands);

/// Raises `more` where the `irradiance` of a solution with it is negative, to 0 there. The second
/// solution may be darker than the first, by which `more` was limited; a third one, with what is
/// raised, is nowhere darker than the second. False if nothing was to be raised.
bool raiseToDark(std::vector<double>& more, std::span<const double> irradiance);

}  // namespace radiosity
