#include "compare/differences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/luminance.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

/// Finds the factor s that minimises the sum of weight |a - s b|^2, and the relative difference
/// that it leaves.
void fit(const ValuePairs& pairs, Comparison& comparison) {
  double ab = 0;
  double bb = 0;
  for (std::size_t p = 0; p < pairs.weights.size(); ++p) {
    const double weight = pairs.weights[p].weight;
    const std::span<const double> a = pairs.ofA(p);
    const std::span<const double> b = pairs.ofB(p);
    for (std::size_t k = 0; k < pairs.bands; ++k) {
      ab += weight * a[k] * b[k];
      bb += weight * b[k] * b[k];
    }
  }
  comparison.fitted_scale = bb > 0 ? ab / bb : 1;
  BandSums sums(int(pairs.bands));
  for (std::size_t p = 0; p < pairs.weights.size(); ++p) {
    sums.add(pairs.weights[p].weight, pairs.ofA(p), pairs.ofB(p), comparison.fitted_scale);
  }
  comparison.fitted_l2 = sums.relativeL2();
}

/// Notes a likely wrong unit: one factor would then remove the difference.
void nameFactor(const CompareOptions& options, Comparison& comparison) {
  const double before = comparison.relativeL2();
  const double scale = comparison.fitted_scale;
  // The factor must remove most of a difference worth naming: then it is no accident of the scene.
  // For a factor that has a meaning, half is enough.
  constexpr double kWorthNaming = 0.05;
  const auto near = [&](double factor) { return std::abs(scale / factor - 1) < 0.05; };
  const double left = near(std::numbers::pi) || near(std::numbers::inv_pi) ? 0.5 : 0.2;
  if (options.fit_scale || before < kWorthNaming || comparison.fitted_l2 > left * before) return;
  const std::string what =
      fmt::format("B times {:.4g} is within {:.3g}% of A, as it stands it is {:.3g}% off", scale,
                  100 * comparison.fitted_l2, 100 * before);
  std::string cause =
      fmt::format("the two differ by one factor: another exposure or unit; {} takes it out",
                  spelled("fit_scale"));
  if (near(std::numbers::pi)) {
    cause = fmt::format(
        "that is pi: B holds radiance where A holds radiosity (B = pi L); say {}, or {}",
        spelled("b_is", "radiance"), spelled("a_is", "radiosity"));
  } else if (near(std::numbers::inv_pi)) {
    cause = fmt::format(
        "that is 1 / pi: B holds radiosity where A holds radiance (B = pi L); say {}, or {}",
        spelled("b_is", "radiosity"), spelled("a_is", "radiance"));
  }
  comparison.notes.push_back({Severity::warning, what + "; " + cause});
}

void findLargest(const ValuePairs& pairs, const std::vector<std::string>& names,
                 Comparison& comparison) {
  double most = -1;
  for (std::size_t p = 0; p < pairs.weights.size(); ++p) {
    const PairWeight& pair = pairs.weights[p];
    const std::span<const double> a = pairs.ofA(p);
    const std::span<const double> b = pairs.ofB(p);
    for (std::size_t k = 0; pair.weight > 0 && k < pairs.bands; ++k) {
      if (!(std::abs(b[k] - a[k]) > most)) continue;
      most = std::abs(b[k] - a[k]);
      comparison.largest = {pair.place, names.empty() ? "" : names[pair.surface], int(k), a[k],
                            b[k]};
    }
  }
}

void sortSurfaces(Comparison& comparison) {
  const auto share = [](const SurfaceDifference& s) {
    return std::accumulate(s.sums.dd.begin(), s.sums.dd.end(), 0.0);
  };
  std::stable_sort(comparison.surfaces.begin(), comparison.surfaces.end(),
                   [&](const auto& s, const auto& t) { return share(s) > share(t); });
}

}  // namespace

BandSums::BandSums(int bands)
    : a(std::size_t(bands), 0.0),
      b(std::size_t(bands), 0.0),
      aa(std::size_t(bands), 0.0),
      dd(std::size_t(bands), 0.0) {}

void BandSums::add(double weight, std::span<const double> of_a, std::span<const double> of_b,
                   double scale) {
  area += weight;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double x = of_a[k];
    const double y = of_b[k] * scale;
    a[k] += weight * x;
    b[k] += weight * y;
    aa[k] += weight * x * x;
    dd[k] += weight * (y - x) * (y - x);
  }
}

double BandSums::relativeL2(int band) const {
  const auto of = [&](const std::vector<double>& sums) {
    return band < 0 ? std::accumulate(sums.begin(), sums.end(), 0.0) : sums[std::size_t(band)];
  };
  if (of(dd) == 0) return 0;
  return of(aa) > 0 ? std::sqrt(of(dd) / of(aa)) : std::numeric_limits<double>::infinity();
}

void measureDifferences(ValuePairs& pairs, const CompareOptions& options,
                        const std::vector<std::string>& surface_names, Comparison& comparison) {
  const int bands = int(pairs.bands);
  fit(pairs, comparison);
  if (options.fit_scale) comparison.scale = comparison.fitted_scale;
  for (double& value : pairs.b) value *= comparison.scale;
  comparison.sums = BandSums(bands);
  std::vector<SurfaceDifference> surfaces(surface_names.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    surfaces[s] = {surface_names[s], 0, BandSums(bands)};
  }
  comparison.difference.reserve(pairs.weights.size());
  BandSums reflecting(bands);
  bool any_emits = false;
  std::vector<double> apart(pairs.bands);
  for (std::size_t p = 0; p < pairs.weights.size(); ++p) {
    const PairWeight& pair = pairs.weights[p];
    if (!(pair.weight > 0)) {
      comparison.difference.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const std::span<const double> a = pairs.ofA(p);
    const std::span<const double> b = pairs.ofB(p);
    ++comparison.cells;
    comparison.sums.add(pair.weight, a, b);
    if (!pair.emits) reflecting.add(pair.weight, a, b);
    any_emits = any_emits || pair.emits;
    if (!surfaces.empty()) surfaces[pair.surface].sums.add(pair.weight, a, b);
    for (std::size_t k = 0; k < pairs.bands; ++k) apart[k] = std::abs(b[k] - a[k]);
    comparison.difference.push_back(brightnessOf(apart));
  }
  if (any_emits) comparison.without_emitters = reflecting;
  comparison.surfaces = std::move(surfaces);
  findLargest(pairs, surface_names, comparison);
  nameFactor(options, comparison);
  sortSurfaces(comparison);
}

}  // namespace radiosity
