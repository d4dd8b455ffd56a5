#include "elements/indirect_light.h"

#include <cmath>
#include <numbers>

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

}  // namespace

void ReflectedLight::addSource(const RayEnd& end, std::span<double> sum) const {
  if (end.patch == RayEnd::kSky) {
    for (std::size_t b = 0; b < sky_.size(); ++b) sum[b] += std::numbers::pi * sky_[b];
  } else if (end.patch != RayEnd::kBlack) {
    sources_.add(end.patch, end.at, sum);
  }
}

double ReflectedLight::irradiance(const SurfacePoint& point, const ElementLights* /*lights*/,
                                  std::span<double> out) const {
  thread_local std::vector<RayEnd> ends;
  thread_local std::vector<double> first;
  ends.resize(set_.rays());
  first.assign(out.size(), 0.0);
  const std::uint64_t bits = placeSeed(point.place + point.normal, seed_);
  const std::size_t number = bits % HemisphereSet::kSets;
  const double turn = 2 * std::numbers::pi * double(bits >> 11) * 0x1p-53;
  rays_.look({point.position, point.normal, surface_.owners[point.owners]}, set_, number, turn,
             ends);
  std::size_t counted = 0;
  std::size_t counted_first = 0;
  std::size_t behind = 0;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (ends[k].patch == RayEnd::kBlack) ++behind;
    if (ends[k].patch == RayEnd::kOwn) continue;
    const bool in_first = set_.isFirst(number, k);
    ++counted;
    counted_first += in_first ? 1 : 0;
    addSource(ends[k], in_first ? std::span<double>(first) : out);
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
  return error * error;
}

}  // namespace radiosity
