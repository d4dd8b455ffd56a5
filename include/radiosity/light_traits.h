// What kinds of lights have in common.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/option_line.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The axis that points up.
enum class Up { y, z };

/// The same as a direction.
inline Vec3 upVector(Up up) { return up == Up::y ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

/// Lumens a watt: of light whose Y is that of the bands, linear Rec. 709 (CIE 1931, photopic).
inline constexpr double kLumensPerWatt = 683;

/// Whether so many bands have a photometric value: three (linear Rec. 709), or one, which is grey.
constexpr bool isPhotometric(int bands) { return bands == 1 || bands == 3; }
/// The photometric value of a radiometric one a band: lx of irradiance in W/m^2, cd/m^2 of radiance
/// in W/m^2/sr, lm of W; kLumensPerWatt times luminance, or times the one band. Errors: InputError
/// unless isPhotometric().
double photometricOf(std::span<const double> bands);
/// The same of each row of N * bands values: N.
std::vector<double> photometricOfEach(std::span<const double> rows, int bands);
/// The conversion in words: "683 lm/W at Y of Rec. 709".
std::string photometricText(int bands);

/// The way by which a light reaches a place, unless something stands in it.
struct LightRay {
  static constexpr double kOutside = std::numeric_limits<double>::infinity();
  Vec3 toward{0.0};            ///< unit, from the place to the light
  double distance = kOutside;  ///< metres; kOutside: the light is beyond the scene
  double share = 0;            ///< irradiance across the way, over the light's strength
};

/// What a kind of light is called.
struct LightTraits {
  const char* word;         ///< of the command line, Python and files
  const char* strength;     ///< the quantity that scales it
  const char* unit;         ///< of the strength
  const char* photometric;  ///< its unit in photometry; 683 of them are one `unit`
  const char* from;         ///< where it comes from, in a few words
  const char* help;         ///< a sentence
  bool single = false;      ///< a scene has one at most: the word is its name
  double usual = 0;         ///< strength by default; 0: it must be given
};

// Parameters that several kinds have.
void describeAt(auto& list, auto& at) {
  list({.name = "at", .value = "X,Y,Z", .unit = "m", .help = "Its place"}, at);
}
void describeRange(auto& list, auto& range) {
  list({.name = "range", .value = "METRES", .unit = "m", .help = "Where it ends; 0: nowhere"},
       range, {.from = 0});
}

/// Where the sun is seen, with the air's refraction.
struct SolarPosition {
  double elevation = 0;  ///< degrees
  double azimuth = 0;    ///< degrees clockwise from north
};

/// J. Michalsky, "The Astronomical Almanac's algorithm for approximate solar position (1950-2050)",
/// Solar Energy 40, 1988: to .01 degrees. `time` as SunPlace::time. Errors: InputError.
SolarPosition solarPosition(double latitude, double longitude, const std::string& time);

/// Where a sun stands, as people say it. Angles, or a place and a time on Earth, replace the
/// direction (settle()).
struct SunPlace {
  Vec3 toward{0.0};                 ///< from the scene to it, of any length; 0: it gives no light
  std::optional<double> elevation;  ///< degrees above the horizon (45 if nothing else is given)
  std::optional<double> azimuth;    ///< degrees clockwise from north, seen from above (180)
  double north = 0;                 ///< degrees by which north is turned clockwise
  double latitude = 0;              ///< degrees north
  double longitude = 0;             ///< degrees east
  std::string time;                 ///< "2026-06-21T12:00+02:00", or Z for UTC; empty: none

  static void describePlace(auto& list, auto& place) {
    list({.name = "toward", .value = "X,Y,Z", .help = "The direction in which it stands"},
         place.toward);
    list({.name = "elevation", .value = "DEGREES", .unit = "degrees", .help = "Above the horizon"},
         place.elevation, {.from = -90, .to = 90});
    list({.name = "azimuth", .value = "DEGREES", .unit = "degrees", .help = "Clockwise from north"},
         place.azimuth, {.from = -360, .to = 360});
    list({.name = "north",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "North, clockwise from +y where z is up, from -z where y is"},
         place.north, {.from = -360, .to = 360});
    list({.name = "latitude", .value = "DEGREES", .unit = "degrees", .help = "Of the scene"},
         place.latitude, {.from = -90, .to = 90});
    list({.name = "longitude", .value = "DEGREES", .unit = "degrees", .help = "Of the scene"},
         place.longitude, {.from = -180, .to = 180});
    list({.name = "time", .value = "DATE", .help = "2026-06-21T12:00+02:00, or Z"}, place.time);
  }

  bool hasAngles() const { return elevation || azimuth || !time.empty(); }
  /// Takes its direction from the angles, or from place and time, which are none then. Errors:
  /// InputError if it is below the horizon, for a time that is none, and for a year that is not
  /// 1950 to 2050.
  void settle(Up up);

  bool operator==(const SunPlace&) const = default;
};

}  // namespace radiosity
