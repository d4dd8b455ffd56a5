#include "solve/energy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace radiosity {

double mostImbalance(const FormFactors& factors) {
  return std::max(traitsOf(factors.method).imbalance, factors.report.error_figure);
}

std::string imbalanceCure(FormFactorMethod method) { return traitsOf(method).cure(); }

void judgeBalance(const FormFactors& factors, std::span<const double> emission,
                  SolveSummary& summary) {
  if (summary.status != SolveStatus::converged) return;
  const double most = mostImbalance(factors);
  const EnergyAccount& energy = summary.energy;
  const std::span<const double> area = factors.matrix->area();
  const double all_area = std::accumulate(area.begin(), area.end(), 0.0);
  const std::size_t bands = energy.emitted.size();
  for (std::size_t b = 0; b < bands; ++b) {
    double brightest = 0;
    for (std::size_t k = b; k < emission.size(); k += bands) {
      brightest = std::max(brightest, emission[k]);
    }
    const double whole = energy.emitted[b] + energy.from_sky[b];
    const double missing = energy.imbalance[b];
    const double explained = most * whole + summary.residual * all_area * brightest;
    if (!(std::abs(missing) > explained)) continue;
    summary.status = SolveStatus::unbalanced;
    summary.message = fmt::format(
        "energy does not balance: in band {}, {:.3g} W of {:.3g} W ({:.3g}%) {}, where the form "
        "factors' errors explain {:.2g}%; not usable; {}",
        b, std::abs(missing), whole, 100 * std::abs(missing) / whole,
        missing > 0 ? "are missing" : "are too much", 100 * explained / whole,
        imbalanceCure(factors.method));
    return;
  }
}

// By reciprocity the light that goes to fronts is the light that falls on them from fronts: sum_i
// A_i fronts_i B_i = sum_j A_j (H_j - S_j); S is the irradiance by lights. The accounts of a row
// sum to 1 and B = E + rho H, so summing A_i B_i both ways gives
//     sum A E + sum A S = sum A (1 - rho) H + sum A sky B + sum A backs B.
// The imbalance of this equation measures missing reciprocity and the residual.
EnergyAccount energyAccount(const FormFactors& factors, std::span<const double> reflectance,
                            const Incoming& incoming, std::span<const double> radiosity,
                            std::span<const double> irradiance, int bands) {
  const auto width = std::size_t(bands);
  const std::vector<double> zeros(width, 0.0);
  EnergyAccount account{zeros, zeros, zeros, zeros, zeros, zeros};
  const std::span<const double> area = factors.matrix->area();
  for (std::size_t i = 0; i < area.size(); ++i) {
    for (std::size_t b = 0; b < width; ++b) {
      const std::size_t k = i * width + b;
      account.emitted[b] += area[i] * incoming.emission[k];
      account.from_sky[b] += area[i] * incoming.by_lights[k];
      account.absorbed[b] += area[i] * (1 - reflectance[k]) * irradiance[k];
      account.to_sky[b] += area[i] * factors.sky[i] * radiosity[k];
      account.on_backs[b] += area[i] * factors.backs[i] * radiosity[k];
    }
  }
  for (std::size_t b = 0; b < width; ++b) {
    account.imbalance[b] = account.emitted[b] + account.from_sky[b] - account.absorbed[b] -
                           account.to_sky[b] - account.on_backs[b];
  }
  return account;
}

}  // namespace radiosity
