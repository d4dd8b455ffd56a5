#include "solve/singular.h"

#include <algorithm>

namespace radiosity {

namespace {

/// 1 - rho and backs + sky below this are 0 to rounding: the accounts are sums of up to 1e5 pixels.
constexpr double kRounding = 1e-13;

using Marks = std::vector<double>;  // 0 or 1

/// Marks every patch that sees a marked one, and so on: sum_j F_ij mark_j > 0 says that i does.
void markAllThatReach(const ExchangeMatrix& matrix, Marks& marked) {
  bool changed = true;
  while (changed) {
    changed = false;
    matrix.sweep(marked, 1, [&](std::size_t i, const double* seen) {
      if (marked[i] != 0 || !(seen[0] > 0)) return;
      marked[i] = 1;
      changed = true;
    });
  }
}

/// Patches of `room` that light from an emitter in it reaches. The room is closed under "sees".
std::vector<std::size_t> litPatches(const System& system, std::size_t band, const Marks& room) {
  const auto bands = std::size_t(system.bands);
  Marks lit(room.size(), 0);
  for (std::size_t i = 0; i < room.size(); ++i) {
    lit[i] = double(room[i] != 0 && system.emission[i * bands + band] > 0);
  }
  markAllThatReach(system.matrix, lit);
  std::vector<std::size_t> patches;
  for (std::size_t i = 0; i < room.size(); ++i) {
    if (room[i] != 0 && lit[i] != 0) patches.push_back(i);
  }
  return patches;
}

}  // namespace

// Power absorbed at i is A_i (1 - rho_i) H_i, and H_i gathers along row i; "light from i reaches j"
// therefore means a stored F_ij, then F_jk, and so on. The patches that reach no loss are closed
// under "sees" and the rows of rho F restricted to them sum to 1: I - rho F is singular there, and
// where one of them emits there is no solution. Raw rows need no symmetry for this to hold.
WhiteRoom findWhiteRoom(const FormFactors& factors, const System& system) {
  const std::size_t n = system.matrix.size();
  const auto bands = std::size_t(system.bands);
  for (std::size_t band = 0; band < bands; ++band) {
    Marks escapes(n);
    for (std::size_t i = 0; i < n; ++i) {
      const bool absorbs = 1 - system.reflectance[i * bands + band] > kRounding;
      const bool leaks = factors.backs[i] + factors.sky[i] > kRounding;
      const bool sees_nothing = factors.fronts[i] <= 0;
      escapes[i] = double(absorbs || leaks || sees_nothing);
    }
    if (std::all_of(escapes.begin(), escapes.end(), [](auto e) { return e != 0; })) continue;
    markAllThatReach(system.matrix, escapes);
    Marks room(n);
    std::transform(escapes.begin(), escapes.end(), room.begin(),
                   [](auto e) { return double(e == 0); });
    const auto patches = litPatches(system, band, room);
    if (!patches.empty()) return {int(band), patches};
  }
  return {};
}

}  // namespace radiosity
