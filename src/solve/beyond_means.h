// What falls on clusters beyond what their matrix gives, made fit to solve with.
#pragma once

#include <span>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity {

/// Area times value, summed over rows of a band; `values`: N * bands, row-major.
double powerOf(std::span<const double> area, std::span<const double> values, int bands, int band);

/// True where some row sees the sky or backs.
bool seesOut(const FormFactors& factors);

/// `more` so that no irradiance falls below 0 by it, and that light is neither made nor lost where
/// all of it falls on fronts: then what differs within clusters falls elsewhere, all in all as
/// much. Both: N * bands, row-major.
std::vector<double> balanced(const FormFactors& factors, std::span<const double> more,
                             std::span<const double> irradiance, int bands);

}  // namespace radiosity
