// Closure with progress.
#pragma once

#include "radiosity/closure.h"

namespace radiosity {

/// See closure.h. Both throw Cancelled; the matrix is then as it was.
ClosureReport restoreClosure(ExchangeMatrix& matrix, std::span<const double> target_row_sums,
                             Progress& progress, double tolerance = 1e-12,
                             int max_iterations = 1000);
ClosureReport closeRows(ExchangeMatrix& matrix, const RawTotals& raw,
                        const UncertainEntries& uncertain, std::span<const double> target_row_sums,
                        bool enforce, Progress& progress, double tolerance = 1e-9);

}  // namespace radiosity
