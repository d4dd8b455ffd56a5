// Finds rooms that neither absorb light nor let it out, and the patches that light reaches.
#pragma once

#include <vector>

#include "radiosity/form_factors.h"
#include "solve/iteration.h"

namespace radiosity {

/// A band of the system in which B = E + rho F B has no finite solution, and its patches.
struct WhiteRoom {
  int band = 0;
  std::vector<std::size_t> patches;
};

/// Marks every row that sees a marked row in the same band, directly or through others: row i does
/// where sum_j F_ij mark_j > 0. `marks`: 0 or 1, N * bands.
void markAllThatSee(const ExchangeOperator& matrix, int bands, std::vector<double>& marks);

/// True if light from this row goes to the sky or to backs. In a closed scene it is false, however
/// far the computed row sums are from 1.
bool looksOut(const FormFactors& factors, std::size_t row);

/// Finds lit patches whose light, however often reflected, reaches no loss: no patch with rho < 1,
/// no sky, no back. Energy comes in and never leaves there: B is infinite. Returns the first band
/// that has such patches; `patches` is empty if there is none. A white room without light does not
/// count: it stays dark.
WhiteRoom findWhiteRoom(const FormFactors& factors, const System& system);

}  // namespace radiosity
