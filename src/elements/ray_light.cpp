#include "elements/ray_light.h"

#include <numbers>

namespace radiosity {

void RayLight::add(const RayEnd& end, const Vec3& from, std::span<double> sum) const {
  if (end.patch == RayEnd::kSky) {
    for (std::size_t b = 0; b < background_.size(); ++b) {
      sum[b] += std::numbers::pi * background_[b];
    }
  } else if (end.patch < RayEnd::kOwn) {
    if (const auto source = sources_.sourceAt(end.patch, end.at, from)) sources_.add(*source, sum);
  }
}

}  // namespace radiosity
