// Exchange of some patches with all others, known before the rest of a matrix is estimated.
#pragma once

#include <cstddef>
#include <vector>

#include "formfactor/row_accounts.h"
#include "radiosity/base.h"

namespace radiosity {

/// The exchange area of a patch with another, m^2.
struct KnownExchange {
  Index patch;
  double exchange;  ///< G, above 0
  double error;     ///< of it, absolute; 0 or more
};

/// The exchange of a patch with all others, and the backs that it sees.
struct KnownRow {
  Index patch;
  std::vector<KnownExchange> entries;  ///< patches ascending
  std::vector<SeenBack> backs;         ///< shares of its view
};

}  // namespace radiosity
