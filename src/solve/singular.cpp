#include "solve/singular.h"

#include <algorithm>

namespace radiosity {

namespace {

/// 1 - rho and backs + sky below this are 0 to rounding: the accounts are sums of up to 1e5 pixels.
constexpr double kNoChange = 1e-13;

using Marks = std::vector<double>;  // 0 or 1

/// The patches of `room` that are lit by an emitter in it. The room is closed under "sees".
std::vector<std::size_t> litPatches(const System& system, std::size_t band, const Marks& room) {
  const auto bands = std::size_t(system.bands);
  Marks lit(room.size(), 0);
  for (std::size_t i = 0; i < room.size(); ++i) {
    lit[i] = double(room[i] != 0 && system.emission[i * bands + band] > 0);
  }
  markAllThatSee(system.matrix, 1, lit);
  std::vector<std::size_t> patches;
  for (std::size_t i = 0; i < room.size(); ++i) {
    if (room[i] != 0 && lit[i] != 0) patches.push_back(i);
  }
  return patches;
}

}  // namespace

void markAllThatSee(const ExchangeOperator& matrix, int bands, std::vector<double>& marks) {
  const auto width = std::size_t(bands);
  bool changed = true;
  const auto update = [&](std::size_t i, const double* seen) {
    for (std::size_t b = 0; b < width; ++b) {
      double& mark = marks[i * width + b];
      if (mark != 0 || seen[b] == 0) continue;
      mark = 1;
      changed = true;
    }
  };
  std::vector<double> seen(matrix.sweeps() ? 0 : marks.size());
  while (changed) {
    changed = false;
    if (seen.empty()) {
      matrix.sweep(marks, bands, update, {});
      continue;
    }
    // A product updates all at once and takes a few steps more.
    matrix.product(marks, bands, seen);
    for (std::size_t i = 0; i < matrix.size(); ++i) update(i, &seen[i * width]);
  }
}

bool looksOut(const FormFactors& factors, std::size_t row) {
  return factors.backs[row] + factors.sky[row] > kNoChange;
}

// The power absorbed at i is A_i (1 - rho_i) H_i, and H_i gathers along row i. So light from i
// reaches k by a chain of stored entries F_ij, F_jk, and so on. The patches whose light reaches no
// loss are closed under "sees", and the rows of rho F restricted to them sum to 1: I - rho F is
// singular there, and if one of them emits, there is no solution. The argument needs no symmetry,
// so it holds for raw rows, too.
WhiteRoom findWhiteRoom(const FormFactors& factors, const System& system) {
  const std::size_t n = system.matrix.size();
  const auto bands = std::size_t(system.bands);
  for (std::size_t band = 0; band < bands; ++band) {
    Marks escapes(n);
    for (std::size_t i = 0; i < n; ++i) {
      const bool absorbs = 1 - system.reflectance[i * bands + band] > kNoChange;
      const bool sees_nothing = factors.fronts[i] <= 0;
      escapes[i] = double(absorbs || looksOut(factors, i) || sees_nothing);
    }
    if (std::all_of(escapes.begin(), escapes.end(), [](auto e) { return e != 0; })) continue;
    markAllThatSee(system.matrix, 1, escapes);
    Marks room(n);
    std::transform(escapes.begin(), escapes.end(), room.begin(),
                   [](auto e) { return double(e == 0); });
    const auto patches = litPatches(system, band, room);
    if (!patches.empty()) return {int(band), patches};
  }
  return {};
}

}  // namespace radiosity
