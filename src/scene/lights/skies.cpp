// Skies above a horizon: how their light is spread.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "base/luminance.h"
#include "radiosity/light.h"

namespace radiosity {

namespace {

/// Radiance towards zeta from the zenith and chi from the sun, but for a factor:
///   (1 + a exp(b / cos zeta)) (f + c exp(d chi) + e cos^2 chi)
/// ISO 15469 has f = 1 - c exp(d pi / 2), Perez f = 1. A factor below 0, as some of Perez' are near
/// the horizon, is 0.
struct SkyShape {
  double a = 0;
  double b = -1;
  double c = 0;
  double d = -1;
  double e = 0;
  double f = 1;
  bool traditional = false;  ///< 1 + 2 cos zeta instead

  double radiance(double cos_zeta, double cos_chi) const {
    if (traditional) return 1 + 2 * cos_zeta;
    const double gradation = a == 0 || !(cos_zeta > 0) ? 1 : 1 + a * std::exp(b / cos_zeta);
    double indicatrix = f + e * cos_chi * cos_chi;
    if (c != 0) indicatrix += c * std::exp(d * std::acos(std::clamp(cos_chi, -1.0, 1.0)));
    return std::max(0.0, gradation) * std::max(0.0, indicatrix);
  }
};

struct CieRow {
  double a, b, c, d, e;
};

/// ISO 15469:2004, table 1.
constexpr std::array<CieRow, 15> kCieRows{{{4, -0.7, 0, -1, 0},
                                           {4, -0.7, 2, -1.5, 0.15},
                                           {1.1, -0.8, 0, -1, 0},
                                           {1.1, -0.8, 2, -1.5, 0.15},
                                           {0, -1, 0, -1, 0},
                                           {0, -1, 2, -1.5, 0.15},
                                           {0, -1, 5, -2.5, 0.3},
                                           {0, -1, 10, -3, 0.45},
                                           {-1, -0.55, 2, -1.5, 0.15},
                                           {-1, -0.55, 5, -2.5, 0.3},
                                           {-1, -0.55, 10, -3, 0.45},
                                           {-1, -0.32, 10, -3, 0.45},
                                           {-1, -0.32, 16, -3, 0.3},
                                           {-1, -0.15, 16, -3, 0.3},
                                           {-1, -0.15, 24, -2.8, 0.15}}};

SkyShape cieShape(int type) {
  if (type == 16) return {.traditional = true};
  const CieRow& row = kCieRows[std::size_t(std::clamp(type, 1, 15) - 1)];
  return {row.a, row.b, row.c, row.d, row.e, 1 - row.c * std::exp(row.d * std::numbers::pi / 2)};
}

/// Perez 1993, table 1: x1 to x4 of a, b, c, d and e, by clearness.
using PerezRow = std::array<std::array<double, 4>, 5>;
constexpr std::array<double, 7> kClearness{1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};
constexpr std::array<PerezRow, 8> kPerezRows{{{{{1.3525, -0.2576, -0.2690, -1.4366},
                                                {-0.7670, 0.0007, 1.2734, -0.1233},
                                                {2.8000, 0.6004, 1.2375, 1.0000},
                                                {1.8734, 0.6297, 0.9738, 0.2809},
                                                {0.0356, -0.1246, -0.5718, 0.9938}}},
                                              {{{-1.2219, -0.7730, 1.4148, 1.1016},
                                                {-0.2054, 0.0367, -3.9128, 0.9156},
                                                {6.9750, 0.1774, 6.4477, -0.1239},
                                                {-1.5798, -0.5081, -1.7812, 0.1080},
                                                {0.2624, 0.0672, -0.2190, -0.4285}}},
                                              {{{-1.1000, -0.2515, 0.8952, 0.0156},
                                                {0.2782, -0.1812, -4.5000, 1.1766},
                                                {24.7219, -13.0812, -37.7000, 34.8438},
                                                {-5.0000, 1.5218, 3.9229, -2.6204},
                                                {-0.0156, 0.1597, 0.4199, -0.5562}}},
                                              {{{-0.5484, -0.6654, -0.2672, 0.7117},
                                                {0.7234, -0.6219, -5.6812, 2.6297},
                                                {33.3389, -18.3000, -62.2500, 52.0781},
                                                {-3.5000, 0.0016, 1.1477, 0.1062},
                                                {0.4659, -0.3296, -0.0876, -0.0329}}},
                                              {{{-0.6000, -0.3566, -2.5000, 2.3250},
                                                {0.2937, 0.0496, -5.6812, 1.8415},
                                                {21.0000, -4.7656, -21.5906, 7.2492},
                                                {-3.5000, -0.1554, 1.4062, 0.3988},
                                                {0.0032, 0.0766, -0.0656, -0.1294}}},
                                              {{{-1.0156, -0.3670, 1.0078, 1.4051},
                                                {0.2875, -0.5328, -3.8500, 3.3750},
                                                {14.0000, -0.9999, -7.1406, 7.5469},
                                                {-3.4000, -0.1078, -1.0750, 1.5702},
                                                {-0.0672, 0.4016, 0.3017, -0.4844}}},
                                              {{{-1.0000, 0.0211, 0.5025, -0.5119},
                                                {-0.3000, 0.1922, 0.7023, -1.6317},
                                                {19.0000, -5.0000, 1.2438, -1.9094},
                                                {-4.0000, 0.0250, 0.3844, 0.2656},
                                                {1.0468, -0.3788, -2.4517, 1.4656}}},
                                              {{{-1.0500, 0.0289, 0.4260, 0.3590},
                                                {-0.3250, 0.1156, 0.7781, 0.0025},
                                                {31.0625, -14.5000, -46.1148, 55.3750},
                                                {-7.2312, 0.4050, 13.3500, 0.6234},
                                                {1.5000, -0.6426, 1.8564, 0.5636}}}}};

/// Eqs. 6 to 8, with the erratum's least brightness between the overcast and the clear sky.
SkyShape perezShape(double clearness, double brightness, double zenith) {
  const auto row =
      std::size_t(std::ranges::upper_bound(kClearness, clearness) - kClearness.begin());
  if (clearness > kClearness.front() && clearness < 2.8) brightness = std::max(0.2, brightness);
  const auto of = [&](std::size_t k) {
    const auto& x = kPerezRows[row][k];
    return x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith);
  };
  SkyShape shape{of(0), of(1), of(2), of(3), of(4), 1};
  if (row == 0) {
    const auto& c = kPerezRows[0][2];
    const auto& d = kPerezRows[0][3];
    shape.c = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
    shape.d = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
  }
  return shape;
}

/// The integral over the sky of radiance times the cosine, by midpoints: they are off by up to
/// 6e-6 of it.
double onLevelGround(const SkyShape& shape, double sun_zenith) {
  constexpr int kRings = 400;
  constexpr int kSectors = 200;  // half way round: the other half is alike
  double sum = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double zeta = (ring + 0.5) * std::numbers::pi / 2 / kRings;
    const double x = std::cos(zeta) * std::cos(sun_zenith);
    const double y = std::sin(zeta) * std::sin(sun_zenith);
    double around = 0;
    for (int k = 0; k < kSectors; ++k) {
      const double turn = (k + 0.5) * std::numbers::pi / kSectors;
      around += shape.radiance(std::cos(zeta), x + y * std::cos(turn));
    }
    sum += std::sin(zeta) * std::cos(zeta) * around;
  }
  return 2 * sum * (std::numbers::pi / 2 / kRings) * (std::numbers::pi / kSectors);
}

Vec3 upOf(const OpenSky& sky) { return sky.up.value_or(Vec3(0, 1, 0)); }

void requireSun(const OpenSky& sky, const char* word) {
  if (sky.sun != Vec3(0.0)) return;
  throw InputError(
      fmt::format("{}: does not know yet where its sun stands: settleSkies() tells it", word));
}

Vec3 sunOf(const OpenSky& sky) { return sky.sun == Vec3(0.0) ? upOf(sky) : sky.sun; }

double zenithAngle(const OpenSky& sky) {
  return std::acos(std::clamp(glm::dot(upOf(sky), sunOf(sky)), -1.0, 1.0));
}

/// Of a sky with that shape, which gives level ground its strength. A band without light has no
/// ground: it is that of another light in a basis.
Dome domeOf(const OpenSky& sky, const SkyShape& shape, std::span<const double> strength) {
  const double whole = onLevelGround(shape, zenithAngle(sky));
  std::vector<double> above(strength.begin(), strength.end());
  std::vector<double> below(strength.size(), 0.0);
  for (std::size_t b = 0; b < above.size(); ++b) {
    const double by_sun = sky.sunlit.empty() ? 0.0 : sky.sunlit[b % sky.sunlit.size()];
    if (above[b] > 0) below[b] = sky.ground * (above[b] + by_sun) * std::numbers::inv_pi;
    above[b] /= whole;
  }
  return [shape, up = upOf(sky), sun = sunOf(sky), above = std::move(above),
          below = std::move(below)](const Vec3& toward, double times, std::span<double> sum) {
    const double cos_zeta = glm::dot(up, toward);
    const bool is_above = cos_zeta > 0;
    const double each = is_above ? times * shape.radiance(cos_zeta, glm::dot(sun, toward)) : times;
    const std::vector<double>& of = is_above ? above : below;
    for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += each * of[b];
  };
}

/// The relative optical air mass (Kasten 1965).
double airMass(double zenith) {
  const double degrees = zenith * 180 / std::numbers::pi;
  return 1 / (std::cos(zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));
}

}  // namespace

void OpenSky::settle(Up scene_up) {
  if (!up) up = upVector(scene_up);
  if (hasAngles()) SunPlace::settle(scene_up);
}

void OpenSky::settleSun(const char* word, bool needs, const Sunlight& sunlight) {
  sunlit = ground > 0 ? sunlight.horizontal : std::vector<double>();
  sun = Vec3(0.0);
  if (!needs) return;
  if (toward == Vec3(0.0) && sunlight.suns != 1) {
    throw InputError(fmt::format(
        "{}: its light depends on where the sun stands, and the scene has {} above the horizon; "
        "give elevation=DEGREES,azimuth=DEGREES, or latitude, longitude and time",
        word, sunlight.suns == 0 ? "none" : std::to_string(sunlight.suns)));
  }
  sun = toward == Vec3(0.0) ? sunlight.toward : glm::normalize(toward);
  if (!(glm::dot(sun, upOf(*this)) > 0)) {
    throw InputError(
        fmt::format("{}: its sun is below the horizon; give an elevation above 0", word));
  }
}

bool CieSky::hasSun() const {
  const SkyShape shape = cieShape(type);
  return shape.c != 0 || shape.e != 0;
}

Dome CieSky::dome(std::span<const double> strength, bool /*whole*/) const {
  if (hasSun()) requireSun(*this, kTraits.word);
  return domeOf(*this, cieShape(type), strength);
}

std::optional<double> CieSky::overcast(double strength) const {
  if (hasSun()) return std::nullopt;
  return strength;
}

Dome PerezSky::dome(std::span<const double> strength, bool /*whole*/) const {
  requireSun(*this, kTraits.word);
  return domeOf(*this, perezShape(clearness, brightness, zenithAngle(*this)), strength);
}

void PerezSky::settleSun(const Sunlight& sunlight, std::span<const double> strength) {
  OpenSky::settleSun(kTraits.word, true, sunlight);
  if (!direct && sunlight.suns != 1) {
    throw InputError(fmt::format(
        "{}: it depends on the direct irradiance of what faces the sun, and the scene has {}; give "
        "direct=W/m^2",
        kTraits.word, sunlight.suns == 0 ? "no sun" : "several suns"));
  }
  const double solar = kLumensPerWatt / efficacy;
  const double diffuse = solar * brightnessOf(strength);
  const double normal = direct.value_or(solar * brightnessOf(sunlight.normal));
  const double zenith = zenithAngle(*this);
  const double cube = 1.041 * std::pow(zenith, 3);
  clearness = ((diffuse + normal) / diffuse + cube) / (1 + cube);
  brightness = diffuse * airMass(zenith) / 1367;
  constexpr double kDimmest = 0.01;
  constexpr double kBrightest = 0.6;
  if (brightness >= kDimmest && brightness <= kBrightest) {
    const SkyShape shape = perezShape(clearness, brightness, zenith);
    if (!(shape.a > 0 && shape.b > 0)) return;
    throw InputError(
        fmt::format("{}: with a clearness of {:.3g} and a brightness of {:.3g} its horizon is "
                    "endlessly bright, "
                    "which no sky is; give more diffuse light",
                    kTraits.word, clearness, brightness));
  }
  throw InputError(fmt::format(
      "{}: {:.4g} W/m^2 of diffuse light is {} than any sky gives with the sun {:.4g} degrees up "
      "(brightness {:.3g} is not within .01 and .6); strengths in lux take "
      "efficacy=LM/W, some 110",
      kTraits.word, diffuse, brightness < kDimmest ? "less" : "more",
      90 - zenith * 180 / std::numbers::pi, brightness));
}

}  // namespace radiosity
