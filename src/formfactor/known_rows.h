// Exchange of some unknowns with all others, known before the rest of a matrix is estimated.
#pragma once

#include <cstddef>
#include <vector>

#include "formfactor/row_accounts.h"
#include "radiosity/base.h"

namespace radiosity {

/// The exchange area of an unknown with another, m^2.
struct KnownExchange {
  Index unknown;
  double exchange;  ///< G, above 0
  double error;     ///< of it, absolute; 0 or more
};

/// The exchange of an unknown with all others, and the backs that it sees.
struct KnownRow {
  Index unknown;
  std::vector<KnownExchange> entries;  ///< unknowns ascending
  std::vector<SeenBack> backs;         ///< shares of its view
};

}  // namespace radiosity
