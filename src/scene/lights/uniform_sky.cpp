#include <numbers>

#include "radiosity/light.h"

namespace radiosity {

double UniformSky::irradiance(double radiance, const LitPlace& place) const {
  return std::numbers::pi * radiance * place.open;
}

Light uniformSky(std::vector<double> radiance) {
  return {UniformSky::kTraits.word, UniformSky(), std::move(radiance)};
}

}  // namespace radiosity
