// Photometric values of radiometric ones.
#include <fmt/format.h>

#include <algorithm>

#include "base/luminance.h"
#include "radiosity/light.h"

namespace radiosity {

namespace {

void requirePhotometric(int bands) {
  if (isPhotometric(bands)) return;
  throw InputError(fmt::format(
      "lux and candela are of three bands (linear Rec. 709) or of one (grey), and there are {}; "
      "take radiometric values by band, W/m^2, and weigh them",
      bands));
}

}  // namespace

double photometricOf(std::span<const double> bands) {
  requirePhotometric(int(bands.size()));
  return kLumensPerWatt * brightnessOf(bands);
}

std::vector<double> photometricOfEach(std::span<const double> rows, int bands) {
  requirePhotometric(bands);
  std::vector<double> values = brightnessOfEach(rows, bands);
  for (double& value : values) value *= kLumensPerWatt;
  return values;
}

std::string photometricText(int bands) {
  return bands == 1 ? fmt::format("{:g} lm/W of the one band: grey", kLumensPerWatt)
                    : fmt::format("{:g} lm/W at Y of Rec. 709", kLumensPerWatt);
}

bool arePhotometric(std::span<const Light> lights) {
  return std::ranges::any_of(
      lights, [](const Light& light) { return light.photometric && light.shines(); });
}

}  // namespace radiosity
