// Lux, and what follows from light at points.
#include <numbers>

#include "radiosity/illuminance.h"

namespace radiosity {

std::span<const double> PointLightValues::directOf(std::size_t point, Measured what) const {
  const auto width = std::size_t(bands);
  return std::span(direct).subspan((point * kMeasured + std::size_t(what)) * width, width);
}

std::span<const double> PointLightValues::indirectOf(std::size_t point, Measured what) const {
  const auto width = std::size_t(bands);
  return std::span(indirect).subspan((point * kMeasured + std::size_t(what)) * width, width);
}

double PointLightValues::directLux(std::size_t point, Measured what) const {
  return photometricOf(directOf(point, what));
}

double PointLightValues::indirectLux(std::size_t point, Measured what) const {
  return photometricOf(indirectOf(point, what));
}

double PointLightValues::lux(std::size_t point, Measured what) const {
  return directLux(point, what) + indirectLux(point, what);
}

double PointLightValues::daylightFactor(std::size_t point) const {
  return open_lux > 0 ? 100 * lux(point, Measured::facing) / open_lux : 0;
}

/// The integral of L sin(t) cos(a) is what the side gets less what its other side gets.
double PointLightValues::semicylindricalLux(std::size_t point, Measured side) const {
  const std::size_t face = std::size_t(side) - std::size_t(Measured::x_plus);
  const auto other = Measured(std::size_t(Measured::x_plus) + (face ^ 1U));
  return lux(point, Measured::cylinder) +
         std::numbers::inv_pi * (lux(point, side) - lux(point, other));
}

std::array<Measured, 4> uprightSides(Up up) {
  using enum Measured;
  if (up == Up::y) return {x_plus, x_minus, z_plus, z_minus};
  return {x_plus, x_minus, y_plus, y_minus};
}

const char* axisOf(Measured what) {
  constexpr std::array<const char*, kMeasured> kAxes = {"", "+x", "-x", "+y", "-y", "+z", "-z", ""};
  return kAxes[std::size_t(what)];
}

IlluminanceSummary summaryOf(const MeasuringPoints& points, const PointLightValues& light,
                             std::size_t first) {
  IlluminanceSummary out;
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (light.inside[first + k] != 0) {
      ++out.inside;
      continue;
    }
    const double value = light.lux(first + k, Measured::facing);
    if (out.points == 0 || value < out.lowest) {
      out.lowest = value;
      out.lowest_at = points.at[k];
    }
    if (out.points == 0 || value > out.highest) {
      out.highest = value;
      out.highest_at = points.at[k];
    }
    ++out.points;
    out.mean += value;
    out.direct += light.directLux(first + k, Measured::facing);
    out.indirect += light.indirectLux(first + k, Measured::facing);
    out.cylinder += light.lux(first + k, Measured::cylinder);
  }
  if (out.points == 0) return out;
  for (double* mean : {&out.mean, &out.direct, &out.indirect, &out.cylinder}) {
    *mean /= double(out.points);
  }
  if (light.open_lux > 0) {
    out.daylight_factor = 100 * out.mean / light.open_lux;
    out.lowest_daylight_factor = 100 * out.lowest / light.open_lux;
  }
  return out;
}

}  // namespace radiosity
