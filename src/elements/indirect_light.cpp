#include "elements/indirect_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/hash.h"

namespace radiosity {
namespace {

/// Well-mixed bits of a place.
std::uint64_t placeSeed(const Vec3& at, std::uint64_t seed) {
  Hash hash;
  hash.bytes(&at, sizeof at);
  hash.bytes(&seed, sizeof seed);
  std::uint64_t bits = hash.value();
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
  return bits ^ (bits >> 31);
}

double total(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

std::uint64_t KeptEnds::keyOf(const SurfacePoint& point) {
  Hash hash;
  hash.bytes(&point.position, sizeof point.position);
  hash.bytes(&point.normal, sizeof point.normal);
  hash.bytes(&point.owners, sizeof point.owners);
  return hash.value();
}

std::uint32_t ReflectedLight::sourceAt(const RayEnd& end) const {
  switch (end.patch) {
    case RayEnd::kSky:
      return KeptEnds::kSky;
    case RayEnd::kBlack:
      return KeptEnds::kBlack;
    case RayEnd::kOwn:
      return KeptEnds::kOwn;
    default:
      return sources_.cellAt(end.patch, end.at).value_or(KeptEnds::kDark);
  }
}

/// Of the set `number`, turned by `turn`. The result holds until the thread's next call.
const std::vector<std::uint32_t>& ReflectedLight::endsOf(const SurfacePoint& point,
                                                         const HemisphereSet& set,
                                                         std::size_t number, double turn) const {
  const bool may_keep = kept_ != nullptr && &set == &set_;
  if (may_keep) {
    if (const std::vector<std::uint32_t>* kept = kept_->find(point)) return *kept;
  }
  thread_local std::vector<RayEnd> ends;
  thread_local std::vector<std::uint32_t> sources;
  ends.resize(set.rays());
  rays_.look({point.position, point.normal, surface_.owners[point.owners]}, set, number, turn,
             ends);
  sources.clear();
  for (const RayEnd& end : ends) sources.push_back(sourceAt(end));
  if (may_keep) kept_->keep(point, sources);
  return sources;
}

void ReflectedLight::addSource(std::uint32_t source, std::span<double> sum) const {
  if (source == KeptEnds::kSky) {
    for (std::size_t b = 0; b < background_.size(); ++b) {
      sum[b] += std::numbers::pi * background_[b];
    }
  } else if (source < KeptEnds::kDark) {
    sources_.add(source, sum);
  }
}

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
  const std::uint64_t bits = placeSeed(point.place + point.normal, seed_);
  const std::size_t number = bits % HemisphereSet::kSets;
  const double turn = 2 * std::numbers::pi * double(bits >> 11) * 0x1p-53;
  const std::vector<std::uint32_t>& ends = endsOf(point, set, number, turn);
  // Where facets meet smoothly, rays past the mean normal's horizon end within the body.
  const bool between_facets = surface_.owners[point.owners].size() > 1;
  std::size_t counted = 0;
  std::size_t counted_first = 0;
  std::size_t behind = 0;
  double squares = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (ends[k] == KeptEnds::kOwn) continue;
    if (ends[k] == KeptEnds::kBlack) {
      ++behind;
      if (between_facets) continue;
    }
    const bool in_first = set.isFirst(number, k);
    ++counted;
    counted_first += in_first ? 1 : 0;
    const std::span<double> sum = in_first ? std::span<double>(first) : out;
    const double before = total(sum);
    addSource(ends[k], sum);
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
