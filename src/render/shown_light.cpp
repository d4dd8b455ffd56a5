// What a picture's light is measured in, for false colours.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/luminance.h"
#include "radiosity/render.h"

namespace radiosity {

std::span<const ShownLight> shownLights() {
  static constexpr std::array kAll = {ShownLight{"radiance", "W/m^2/sr", false, false},
                                      ShownLight{"luminance", "cd/m^2", true, false},
                                      ShownLight{"illuminance", "lx", true, true}};
  return kAll;
}

FalseColour legendOf(const ShownLight& shown, int bands) {
  const std::string of_bands = shown.photometric ? "" : brightnessText(bands);
  return {.title = shown.name + of_bands, .unit = shown.unit};
}

std::vector<double> shownValues(const Image& radiance, const ShownLight& shown) {
  std::vector<double> values;
  values.reserve(radiance.rgba.size() / 4);
  for (std::size_t k = 0; k < radiance.rgba.size(); k += 4) {
    const float* p = &radiance.rgba[k];
    const double colour[] = {p[0], p[1], p[2]};
    const double value = shown.photometric ? photometricOf(colour) : brightnessOf(colour);
    values.push_back(p[3] > 0 ? (shown.falling ? std::numbers::pi : 1) * value
                              : std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

}  // namespace radiosity
