// Finds rooms that light cannot leave and nothing absorbs.
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

/// The patches from which light, however often reflected, reaches no loss: no patch with rho < 1,
/// no sky, no back; and which an emitter lights. Energy comes in and never leaves: B is infinite.
/// The first band that has such patches; none: `patches` is empty. A white room without light is
/// no such room: it stays dark.
WhiteRoom findWhiteRoom(const FormFactors& factors, const System& system);

}  // namespace radiosity
