// What every method does with its rows: who is seen from behind, and what does not fit.
#pragma once

#include <utility>
#include <vector>

#include "radiosity/form_factors.h"

namespace radiosity {

/// Black backs one row sees.
struct SeenBack {
  Index surface;
  double share;
};

/// Fills backs_by_surface from what each row saw (N lists) and warns, by name, of surfaces whose
/// backs take more than 0.1% of the view. Needs the accounts.
void accountForBacks(const PatchMesh& mesh, const std::vector<std::vector<SeenBack>>& seen_backs,
                     FormFactors& result);

/// RunError, with the numbers, where `bytes` exceed the limit.
void refuseTooLarge(std::size_t bytes, const FormFactorOptions& options, std::size_t patches);

}  // namespace radiosity
