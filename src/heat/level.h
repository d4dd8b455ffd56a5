// Where heat has a way out, and what light reaches.
#pragma once

#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity {

/// Marks, 0 or 1, N * bands: spreads them to every row that sees a marked one in that band.
void markAllThatSee(const ExchangeMatrix& matrix, int bands, std::vector<double>& marks);

/// True where some of what leaves a row ends on the sky or on backs. In a closed scene it is false,
/// however far computed rows are from 1.
bool looksOut(const FormFactors& factors, std::size_t row);

}  // namespace radiosity
