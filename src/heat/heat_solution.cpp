// The results of a finished solve: figures of rows and the balance of heat.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "heat/heat_solve.h"
#include "radiosity/solve.h"

namespace radiosity {

/// Refuses temperatures outside their tables of emissivity: the emissivity is not known there.
void HeatSolve::requireTables() const {
  for (std::size_t i = 0; i < n_; ++i) {
    const Index node = nodes_.of_row[i];
    if (node != kNone && !(gain_[node] > 0)) continue;
    for (const Emissivity& e : conditionOf(i).emissivity) {
      if (e.temperatures.empty()) continue;
      const double t = temperature_[i];
      if (t >= e.temperatures.front() && t <= e.temperatures.back()) continue;
      throw InputError(fmt::format(
          "{}: reaches {:.6g} K, and its emissivity is given from {:g} to {:g} K; extend the table",
          conditionOf(i).name, t, e.temperatures.front(), e.temperatures.back()));
    }
  }
}

HeatSolution HeatSolve::solutionOf(HeatFields fields) const {
  HeatSolution solution;
  solution.bands = int(width_);
  solution.radiosity = std::move(fields.radiosity);
  solution.irradiance = std::move(fields.irradiance);
  solution.temperature = temperature_;
  solution.net_flux.assign(n_, 0.0);
  solution.convection.assign(n_, 0.0);
  for (std::size_t i = 0; i < n_; ++i) {
    for (std::size_t k = i * width_; k < (i + 1) * width_; ++k) {
      solution.net_flux[i] += solution.radiosity[k] - solution.irradiance[k];
    }
    const Index node = nodes_.of_row[i];
    if (node != kNone && !(gain_[node] > 0)) {
      solution.temperature[i] = std::numeric_limits<double>::quiet_NaN();
      ++solution.summary.undetermined;
    } else {
      const HeatCondition& c = conditionOf(i);
      solution.convection[i] = c.convection * (temperature_[i] - c.ambient);
    }
  }
  solution.summary.balance = balanceOf(solution);
  return solution;
}

// The radiosity of row i that does not reach fronts ends on the sky or on backs. So with
// reciprocity and rows that sum to 1, sum A (J - H) = sum A sky (J - E_sky) + sum A backs J.
// Irradiance on fronts beyond that of the matrix is subtracted from the heat to the sky.
HeatBalance HeatSolve::balanceOf(const HeatSolution& solution) const {
  HeatBalance balance;
  std::vector<double> of_condition(rows_.conditions.size(), 0.0);
  for (std::size_t i = 0; i < n_; ++i) {
    const double radiated = area_[i] * solution.net_flux[i];
    balance.radiated += radiated;
    of_condition[rows_.of_row[i]] += radiated;
    balance.convected += area_[i] * solution.convection[i];
    for (std::size_t k = i * width_; k < (i + 1) * width_; ++k) {
      balance.to_sky +=
          area_[i] * (std::max(0.0, factors_.sky[i]) * solution.radiosity[k] - falling_[k]);
      balance.on_backs += area_[i] * factors_.backs[i] * solution.radiosity[k];
    }
  }
  for (const double power : of_condition) balance.throughput += std::max(0.0, power);
  balance.imbalance = balance.radiated - balance.to_sky - balance.on_backs;
  return balance;
}

/// Net powers are the measure, unless all are small beside what surfaces give off: then they are
/// differences of it, which rounding and the tolerance leave.
void HeatSolve::judgeBalance(HeatSolution& solution) const {
  constexpr double kSmall = 1e-4;
  HeatSummary& summary = solution.summary;
  const HeatBalance& balance = summary.balance;
  double given_off = 0;
  for (std::size_t k = 0; k < solution.radiosity.size(); ++k) {
    given_off += area_[k / width_] * solution.radiosity[k];
  }
  const double explained =
      std::max(mostImbalance(factors_) * balance.throughput, kSmall * given_off);
  if (summary.status != HeatStatus::converged || !(std::abs(balance.imbalance) > explained)) return;
  summary.status = HeatStatus::unbalanced;
  summary.message = fmt::format(
      "heat does not balance: {:.3g} W {}, where {:.3g} W are exchanged and the form factors' "
      "errors "
      "explain {:.2g} W; not usable; {}",
      std::abs(balance.imbalance), balance.imbalance > 0 ? "are missing" : "are too much",
      balance.throughput, explained, imbalanceCure(factors_.method));
}

}  // namespace radiosity
