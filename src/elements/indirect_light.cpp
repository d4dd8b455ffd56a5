#include "elements/indirect_light.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace radiosity {
namespace {

double total(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

double ReflectedLight::irradiance(const SurfacePoint& point, const ElementLights* /*lights*/,
                                  std::span<double> out) const {
  double spread = 0;
  const double error = look(point, set_, out, spread);
  if (more_ == nullptr || error < 0) return error;
  const double apart = apart_ * total(out);
  if (spread <= uneven_ && error <= apart * apart) return error;
  ++repeated_;
  std::fill(out.begin(), out.end(), 0.0);
  return look(point, *more_, out, spread);
}

/// `spread`: the standard error of as many random rays over their mean.
double ReflectedLight::look(const SurfacePoint& point, const HemisphereSet& set,
                            std::span<double> out, double& spread) const {
  thread_local std::vector<double> first;
  first.assign(out.size(), 0.0);
  thread_local std::vector<RayEnd> ends;
  ends.resize(set.rays());
  const HemisphereSet::Turn turn = set.turnAt(point.place + point.normal, seed_);
  rays_.look({point.position, point.normal, surface_.owners[point.owners]}, set, turn.set,
             turn.angle, ends);
  // Where facets meet smoothly, rays past the mean normal's horizon end within the body.
  const bool between_facets = surface_.owners[point.owners].size() > 1;
  std::size_t counted = 0;
  std::size_t counted_first = 0;
  std::size_t behind = 0;
  double squares = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (ends[k].patch == RayEnd::kOwn) continue;
    if (ends[k].patch == RayEnd::kBlack) {
      ++behind;
      if (between_facets) continue;
    }
    const bool in_first = set.isFirst(turn.set, k);
    ++counted;
    counted_first += in_first ? 1 : 0;
    const std::span<double> sum = in_first ? std::span<double>(first) : out;
    const double before = total(sum);
    light_.add(ends[k], point.position, sum);
    const double brought = total(sum) - before;
    squares += brought * brought;
  }
  if (counted == 0 || 2 * behind > ends.size()) return -1;
  double error = 0;
  const std::size_t counted_second = counted - counted_first;
  for (std::size_t b = 0; b < out.size(); ++b) {
    const double mean = (out[b] + first[b]) / double(counted);
    if (counted_first > 0 && counted_second > 0) {
      const double apart = first[b] / double(counted_first) - out[b] / double(counted_second);
      error += 0.5 * std::abs(apart);
    }
    out[b] = mean;
  }
  const double mean = total(out);
  spread = mean > 0 ? std::sqrt(std::max(0.0, squares / double(counted) / (mean * mean) - 1) /
                                double(counted))
                    : 0.0;
  return error * error;
}

}  // namespace radiosity
