#include "elements/ray_light.h"

#include <numbers>

namespace radiosity {

void RayLight::add(const RayEnd& end, const Vec3& from, std::span<double> sum) const {
  if (end.patch == RayEnd::kSky) {
    background_.add(end.at, std::numbers::pi, sum);
  } else if (end.patch < RayEnd::kOwn) {
    if (const auto source = sources_.sourceAt(end.patch, end.at, from)) sources_.add(*source, sum);
  }
}

}  // namespace radiosity
