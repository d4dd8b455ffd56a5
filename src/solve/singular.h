// Where light has a way out, what it reaches, and rooms that it cannot leave and nothing absorbs.
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

/// Marks, 0 or 1, N * bands: spreads them to every row that sees a marked one in that band:
/// sum_j F_ij mark_j > 0 says that row i does.
void markAllThatSee(const ExchangeMatrix& matrix, int bands, std::vector<double>& marks);

/// True where some of what leaves a row ends on the sky or on backs. In a closed scene it is false,
/// however far computed rows are from 1.
bool looksOut(const FormFactors& factors, std::size_t row);

/// The patches from which light, however often reflected, reaches no loss: no patch with rho < 1,
/// no sky, no back; and which an emitter lights. Energy comes in and never leaves: B is infinite.
/// The first band that has such patches; none: `patches` is empty. A white room without light is
/// no such room: it stays dark.
WhiteRoom findWhiteRoom(const FormFactors& factors, const System& system);

}  // namespace radiosity
