#include "compare/differences.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/luminance.h"

namespace radiosity {
namespace {

/// The factor s that makes sum of weight |a - s b|^2 least, and what is left of |a|.
void fit(const std::vector<ValuePair>& pairs, Comparison& comparison) {
  double ab = 0;
  double bb = 0;
  for (const ValuePair& pair : pairs) {
    for (int k = 0; k < 3; ++k) {
      ab += pair.weight * pair.a[k] * pair.b[k];
      bb += pair.weight * pair.b[k] * pair.b[k];
    }
  }
  comparison.fitted_scale = bb > 0 ? ab / bb : 1;
  BandSums sums;
  for (const ValuePair& pair : pairs) {
    sums.add(pair.weight, pair.a, pair.b * comparison.fitted_scale);
  }
  comparison.fitted_l2 = sums.relativeL2();
}

/// A wrong unit makes a difference that one factor takes away.
void nameFactor(const CompareOptions& options, Comparison& comparison) {
  const double before = comparison.relativeL2();
  const double scale = comparison.fitted_scale;
  // Most of a difference worth naming goes with the factor: it is no accident of the scene. Of a
  // factor that means something, half is enough.
  constexpr double kWorthNaming = 0.05;
  const auto near = [&](double factor) { return std::abs(scale / factor - 1) < 0.05; };
  const double left = near(std::numbers::pi) || near(std::numbers::inv_pi) ? 0.5 : 0.2;
  if (options.fit_scale || before < kWorthNaming || comparison.fitted_l2 > left * before) return;
  const std::string what =
      fmt::format("B times {:.4g} is within {:.3g}% of A, as it stands it is {:.3g}% off", scale,
                  100 * comparison.fitted_l2, 100 * before);
  std::string cause =
      "the two differ by one factor: another exposure or unit; --fit-scale takes it out";
  if (near(std::numbers::pi)) {
    cause =
        "that is pi: B holds radiance where A holds radiosity (B = pi L); say --b-is radiance, or "
        "--a-is radiosity";
  } else if (near(std::numbers::inv_pi)) {
    cause =
        "that is 1 / pi: B holds radiosity where A holds radiance (B = pi L); say --b-is "
        "radiosity, or --a-is radiance";
  }
  comparison.notes.push_back({Severity::warning, what + "; " + cause});
}

void findLargest(const std::vector<ValuePair>& pairs, const std::vector<std::string>& names,
                 Comparison& comparison) {
  double most = -1;
  for (const ValuePair& pair : pairs) {
    for (int k = 0; pair.weight > 0 && k < 3; ++k) {
      if (!(std::abs(pair.b[k] - pair.a[k]) > most)) continue;
      most = std::abs(pair.b[k] - pair.a[k]);
      comparison.largest = {pair.place, names.empty() ? "" : names[pair.surface], k, pair.a[k],
                            pair.b[k]};
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

void BandSums::add(double weight, const Vec3& value_a, const Vec3& value_b) {
  area += weight;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = value_a[int(k)];
    const double y = value_b[int(k)];
    a[k] += weight * x;
    b[k] += weight * y;
    aa[k] += weight * x * x;
    dd[k] += weight * (y - x) * (y - x);
  }
}

double BandSums::relativeL2(int band) const {
  const auto of = [&](const std::array<double, 3>& sums) {
    return band < 0 ? sums[0] + sums[1] + sums[2] : sums[std::size_t(band)];
  };
  if (of(dd) == 0) return 0;
  return of(aa) > 0 ? std::sqrt(of(dd) / of(aa)) : std::numeric_limits<double>::infinity();
}

void measureDifferences(std::vector<ValuePair>& pairs, const CompareOptions& options,
                        const std::vector<std::string>& surface_names, Comparison& comparison) {
  fit(pairs, comparison);
  if (options.fit_scale) comparison.scale = comparison.fitted_scale;
  std::vector<SurfaceDifference> surfaces(surface_names.size());
  for (std::size_t s = 0; s < surfaces.size(); ++s) surfaces[s].name = surface_names[s];
  comparison.difference.reserve(pairs.size());
  BandSums reflecting;
  bool any_emits = false;
  for (ValuePair& pair : pairs) {
    if (!(pair.weight > 0)) {
      comparison.difference.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    pair.b *= comparison.scale;
    ++comparison.cells;
    comparison.sums.add(pair.weight, pair.a, pair.b);
    if (!pair.emits) reflecting.add(pair.weight, pair.a, pair.b);
    any_emits = any_emits || pair.emits;
    if (!surfaces.empty()) surfaces[pair.surface].sums.add(pair.weight, pair.a, pair.b);
    const Vec3 apart = pair.b - pair.a;
    comparison.difference.push_back(
        luminanceOf({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)}));
  }
  if (any_emits) comparison.without_emitters = reflecting;
  comparison.surfaces = std::move(surfaces);
  findLargest(pairs, surface_names, comparison);
  nameFactor(options, comparison);
  sortSurfaces(comparison);
}

}  // namespace radiosity
