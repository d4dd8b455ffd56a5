// Where the sun stands, and its light.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "base/finite.h"
#include "base/geometry/plane_frame.h"
#include "radiosity/light.h"
#include "scene/lights/light_text.h"

namespace radiosity {

namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180; }
double degreesOf(double radians) { return radians * 180 / std::numbers::pi; }

/// From 0 to 360.
double turned(double degrees) { return degrees - 360 * std::floor(degrees / 360); }

/// A time in UTC.
struct Instant {
  double days = 0;   ///< since noon of the 1st of January 2000
  double hours = 0;  ///< of its day
};

[[noreturn]] void failAtTime(const std::string& time, const char* what) {
  throw InputError(
      fmt::format("sun: the time '{}' {}; write 2026-06-21T12:00+02:00, or Z for UTC", time, what));
}

/// Hours that "+02:00" or "Z" is ahead of UTC.
double zoneHours(const std::string& time, const char* zone) {
  if (std::string_view(zone) == "Z") return 0;
  int hours = 0;
  int minutes = 0;
  int read = 0;
  const bool signed_zone = *zone == '+' || *zone == '-';
  if (!signed_zone || std::sscanf(zone + 1, "%2d:%2d%n", &hours, &minutes, &read) != 2 ||
      zone[1 + read] != '\0' || hours > 14 || minutes > 59) {
    failAtTime(time, *zone == '\0' ? "has no zone" : "has a zone that is none");
  }
  return (*zone == '-' ? -1 : 1) * (hours + minutes / 60.0);
}

Instant instantOf(const std::string& time) {
  using namespace std::chrono;
  int y = 0;
  unsigned mo = 0;
  unsigned d = 0;
  int h = 0;
  int mi = 0;
  int s = 0;
  int read = 0;
  if (std::sscanf(time.c_str(), "%4d-%2u-%2uT%2d:%2d%n", &y, &mo, &d, &h, &mi, &read) != 5) {
    failAtTime(time, "is no date with a time");
  }
  int more = 0;
  if (time[std::size_t(read)] == ':' &&
      std::sscanf(time.c_str() + read, ":%2d%n", &s, &more) == 1) {
    read += more;
  }
  const year_month_day date{year(y), month(mo), day(d)};
  if (!date.ok() || h < 0 || h > 24 || mi < 0 || mi > 59 || s < 0 || s > 60) {
    failAtTime(time, "does not exist");
  }
  if (y < 1950 || y > 2050) failAtTime(time, "is not within 1950 and 2050");
  const double hours = h + mi / 60.0 + s / 3600.0 - zoneHours(time, time.c_str() + read);
  const auto since = sys_days(date) - sys_days(year(2000) / January / 1);
  const double days = double(since.count()) - 0.5 + hours / 24;
  return {days, hours};
}

/// Degrees by which the air raises the sun (Michalsky's eq. for 1013.25 hPa and 15 C).
double refraction(double elevation) {
  if (elevation <= -0.56) return 0.56;
  const double e = elevation;
  return 3.51561 * (0.1594 + 0.0196 * e + 0.00002 * e * e) / (1 + 0.505 * e + 0.0845 * e * e);
}

}  // namespace

SolarPosition solarPosition(double latitude, double longitude, const std::string& time) {
  const auto [days, hours] = instantOf(time);
  const double anomaly = radians(turned(357.528 + 0.9856003 * days));
  const double mean_longitude = turned(280.460 + 0.9856474 * days);
  const double ecliptic =
      radians(mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly));
  const double obliquity = radians(23.439 - 0.0000004 * days);
  const double ascension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
  const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
  const double sidereal = 6.697375 + 0.0657098242 * days + hours;  // hours, at Greenwich
  const double hour_angle = radians(turned(15 * sidereal + longitude)) - ascension;
  const double lat = radians(latitude);
  const double sine = std::sin(declination) * std::sin(lat) +
                      std::cos(declination) * std::cos(lat) * std::cos(hour_angle);
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north = std::sin(declination) * std::cos(lat) -
                       std::cos(declination) * std::sin(lat) * std::cos(hour_angle);
  const double elevation = degreesOf(std::asin(std::clamp(sine, -1.0, 1.0)));
  return {elevation + refraction(elevation), turned(degreesOf(std::atan2(east, north)))};
}

LightRay Sun::ray(const Vec3& /*place*/, double u, double v) const {
  if (toward == Vec3(0.0)) return {};
  const Vec3 axis = glm::normalize(toward);
  if (!(diameter > 0)) return {axis, LightRay::kOutside, 1};
  const PlaneFrame frame = makeFrame(Vec3(0.0), axis, axisAcross(axis));
  // A disc's points by area: the square root of u from its middle.
  const double off = std::tan(radians(diameter) / 2) * std::sqrt(u);
  const double angle = 2 * std::numbers::pi * v;
  const Vec3 way = axis + off * (std::cos(angle) * frame.u + std::sin(angle) * frame.v);
  return {glm::normalize(way), LightRay::kOutside, 1};
}

// Ways to points of a flat disc of radius t, of unit length: their mean along the axis is that of
// 1 / sqrt(1 + r^2), 2 (sqrt(1 + t^2) - 1) / t^2.
std::optional<double> Sun::share(const Vec3& a, const Vec3& b, const Vec3& c) const {
  const Vec3 across = glm::cross(b - a, c - a);
  const double length = glm::length(across);
  if (!(length > 0) || toward == Vec3(0.0)) return std::nullopt;
  const double cosine = std::abs(glm::dot(across, glm::normalize(toward))) / length;
  const double square = std::pow(std::tan(radians(diameter) / 2), 2);
  if (cosine * cosine <= square) return std::nullopt;
  return cosine * 2 / (1 + std::sqrt(1 + square));
}

SolarPosition standingOf(const Vec3& toward, Up up) {
  const double high = up == Up::z ? toward.z : toward.y;
  const double to_north = up == Up::z ? toward.y : -toward.z;
  return {degreesOf(std::atan2(high, std::hypot(toward.x, to_north))),
          turned(degreesOf(std::atan2(toward.x, to_north)))};
}

void SunPlace::settle(Up up) {
  if (!isFinite(toward)) throw InputError("sun: toward is not three finite numbers");
  if (toward != Vec3(0.0) && !hasAngles()) return;
  if (!time.empty()) {
    const SolarPosition stands = solarPosition(latitude, longitude, time);
    elevation = stands.elevation;
    azimuth = stands.azimuth;
  }
  // Of two angles the one that is not given stays as it is.
  SolarPosition now{45, 180};
  if (toward != Vec3(0.0)) now = standingOf(toward, up);
  const double height = elevation.value_or(now.elevation);
  if (!(height > 0)) {
    throw InputError(fmt::format(
        "sun: {}it is {:.1f} degrees below the horizon and gives no "
        "light; {}",
        time.empty() ? "" : "at " + time + " ", -height,
        time.empty() ? "for light from below give toward=X,Y,Z" : "give a time of day"));
  }
  const double e = radians(height);
  const double a = radians(azimuth.value_or(now.azimuth) + north);
  const double to_east = std::cos(e) * std::sin(a);
  const double to_north = std::cos(e) * std::cos(a);
  const Vec3 direction =
      up == Up::z ? Vec3(to_east, to_north, std::sin(e)) : Vec3(to_east, std::sin(e), -to_north);
  *this = SunPlace();
  toward = direction;
}

}  // namespace radiosity
