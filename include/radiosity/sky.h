// Skies that are not alike in all directions: kinds of lights (light.h).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/light_traits.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The radiance of a sky, made ready: adds `times` that of a direction, unit, to a value a band,
/// W/m^2/sr.
using Dome = std::function<void(const Vec3& toward, double times, std::span<double> sum)>;

/// The suns of a scene, as they light its ground and its sky.
struct Sunlight {
  std::size_t suns = 0;            ///< above the horizon
  Vec3 toward{0.0};                ///< unit, to the last of them
  std::vector<double> normal;      ///< W/m^2 a band, of what faces it
  std::vector<double> horizontal;  ///< W/m^2 a band, of level ground, by all of them
};

/// What skies with a horizon have in common: where their sun stands, which is that of the scene
/// unless it is given, and the ground below, which reflects alike in all directions what the sky
/// and the scene's suns give it. It is a part of the sky: dimmed with it, dark without it.
struct OpenSky : SunPlace {
  double ground = 0;           ///< reflectance; 0: nothing comes from below the horizon
  std::optional<Vec3> up;      ///< unit, which settle() sets; none: y
  Vec3 sun{0.0};               ///< unit, which settleSun() sets; 0: of a sky that needs none
  std::vector<double> sunlit;  ///< W/m^2 a band, likewise: of the ground by suns

  static void describeOpen(auto& list, auto& sky) {
    describePlace(list, sky);
    list({.name = "ground",
          .value = "REFLECTANCE",
          .help = "Of what is below the horizon, lit by sky and sun (0: dark)"},
         sky.ground, {.from = 0, .to = 1});
    list({.name = "up", .value = "X,Y,Z"}, sky.up);
    list({.name = "sun", .value = "X,Y,Z"}, sky.sun);
    list({.name = "sunlit", .value = "W"}, sky.sunlit);
  }

  void settle(Up scene_up);
  /// Of a sky that `needs` it: throws InputError, which calls it `word`, without a sun above the
  /// horizon.
  void settleSun(const char* word, bool needs, const Sunlight& sunlight);

  bool operator==(const OpenSky&) const = default;
};

/// The CIE standard general skies, ISO 15469:2004 (CIE S 011), types 1 to 15, and 16, the CIE
/// traditional overcast sky (Moon & Spencer 1942): (1 + 2 sin(elevation)) / 3 of the zenith's.
struct CieSky : OpenSky {
  static constexpr LightTraits kTraits{
      .word = "cie-sky",
      .strength = "diffuse",
      .unit = "W/m^2",
      .photometric = "lx",
      .from = "from above the horizon",
      .help =
          "A sky as CIE has standardised it: what open level ground gets from it, W/m^2 or lx "
          "(10000lx), one number or R,G,B, then type=1 to 16, e.g. 1 overcast (default), 5 alike "
          "all over, 12 clear, 16 overcast, traditional; those with a sun take that of the scene, "
          "or elevation=DEGREES,azimuth=DEGREES and so on as of a sun, which gives no light "
          "itself; ground=REFLECTANCE below the horizon (default 0)",
      .single = true};
  int type = 1;

  static void describe(auto& list, auto& sky) {
    list({.name = "type", .help = "Of ISO 15469, 1 to 15, or 16: traditional overcast"}, sky.type,
         {.from = 1, .to = 16});
    describeOpen(list, sky);
  }

  bool hasSun() const;  ///< it is not alike all around the zenith
  Dome dome(std::span<const double> strength, bool whole) const;
  std::optional<double> overcast(double strength) const;
  void settleSun(const Sunlight& sunlight, std::span<const double> /*strength*/) {
    OpenSky::settleSun(kTraits.word, hasSun(), sunlight);
  }

  bool operator==(const CieSky&) const = default;
};

/// R. Perez, R. Seals & J. Michalsky, "All-weather model for sky luminance distribution", Solar
/// Energy 50, 1993, from the diffuse irradiance of level ground, which is its strength, and the
/// direct irradiance of what faces the sun. That light itself is a sun's. The sun's distance is
/// taken to be its mean.
struct PerezSky : OpenSky {
  static constexpr LightTraits kTraits{
      .word = "perez-sky",
      .strength = "diffuse",
      .unit = "W/m^2",
      .photometric = "lx",
      .from = "from above the horizon",
      .help =
          "The sky of a weather record, by Perez (1993): the diffuse irradiance of open level "
          "ground, W/m^2 or lx, one number or R,G,B; with it goes the sun of the scene, or "
          "direct=W/m^2 of what faces the sun, and where that stands (elevation=DEGREES,"
          "azimuth=DEGREES and so on), which gives no light itself; ground=REFLECTANCE below the "
          "horizon (default 0)",
      .single = true};
  std::optional<double> direct;      ///< W/m^2 of the whole spectrum; none: the scene's sun's
  double efficacy = kLumensPerWatt;  ///< lm/W: of the light that strengths measure
  double clearness = 0;              ///< epsilon, which settleSun() sets
  double brightness = 0;             ///< Delta, likewise

  static void describe(auto& list, auto& sky) {
    list({.name = "direct",
          .value = "W",
          .unit = "W/m^2",
          .help = "Of what faces the sun, in the whole spectrum"},
         sky.direct, {.from = 0});
    list({.name = "efficacy",
          .value = "LM/W",
          .unit = "lm/W",
          .help = "Of daylight, some 110, where strengths are lux: tells what they are in W/m^2 "
                  "of the whole spectrum"},
         sky.efficacy, {.to = kLumensPerWatt, .above = 0});
    describeOpen(list, sky);
    list({.name = "clearness"}, sky.clearness);
    list({.name = "brightness"}, sky.brightness);
  }

  Dome dome(std::span<const double> strength, bool whole) const;
  void settleSun(const Sunlight& sunlight, std::span<const double> strength);

  bool operator==(const PerezSky&) const = default;
};

/// An image of all directions as a parameter of a light (option_line.h): equirectangular, its top
/// row up. It is read at once, by its path, which files keep with a hash of the image.
class SkyImage {
 public:
  /// A texel that is brighter than all but spots are.
  struct Spot {
    std::uint32_t texel;
    double until;  ///< of all spots up to here: the luminance above that, over solid angle
  };
  struct Texels {
    int width = 0;
    int height = 0;
    std::vector<float> rgb;   ///< width * height * 3, linear
    std::vector<float> kept;  ///< width * height: the share that is no spot; or empty: all
    std::vector<Spot> spots;
    Vec3 spot_colour{0.0};  ///< of luminance 1
  };

  const std::string& name() const { return path_; }
  bool empty() const { return !texels_; }
  const Texels& texels() const { return *texels_; }

  /// "PATH|HASH", the path as of lights (light.h); empty if it is.
  std::string optionText() const;
  /// Takes such a text or a path, and reads the image. Errors: InputError.
  bool readOption(std::string_view text);
  bool operator==(const SkyImage& other) const { return optionText() == other.optionText(); }

 private:
  std::string path_;
  std::string hash_;
  std::shared_ptr<const Texels> texels_;
};

/// A sky as an image shows it, below the horizon too. Its middle column is in the north (+y where z
/// is up, -z where y is), what is right of it to the east. Three bands are its colours, one is
/// their luminance. What is far brighter than the rest, such as a sun, rays would find by chance:
/// it is an aimed light to them.
struct ImageSky {
  static constexpr LightTraits kTraits{
      .word = "image-sky",
      .strength = "radiance",
      .unit = "W/m^2/sr",
      .photometric = "cd/m^2",
      .from = "from where nothing stands",
      .help =
          "A sky as an image shows it: FILE.hdr or .exr, equirectangular, its top row up and its "
          "middle in the north; then the radiance of a value of 1, W/m^2/sr or cd/m^2 (default "
          "1); turn=DEGREES, clockwise seen from above",
      .single = true,
      .usual = 1};
  SkyImage file;
  double turn = 0;         ///< degrees, clockwise seen from above
  std::optional<Vec3> up;  ///< unit, which settle() sets; none: y

  static constexpr const char* kUnnamed[] = {"file"};
  static void describe(auto& list, auto& sky) {
    list({.name = "file", .value = "SKY.hdr|.exr", .help = "Equirectangular"}, sky.file);
    list({.name = "turn",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "Clockwise, seen from above"},
         sky.turn, {.from = -360, .to = 360});
    list({.name = "up", .value = "X,Y,Z"}, sky.up);
  }

  /// Not `whole`: without its spots.
  Dome dome(std::span<const double> strength, bool whole) const;
  bool isWide(const Vec3& /*place*/) const { return true; }
  /// To a place of a spot; spots are chosen by the light that they send.
  LightRay ray(const Vec3& place, double u, double v) const;
  /// What the strength of a band is times for its spots; 0: it has none.
  double ofSpots(std::size_t band, std::size_t bands) const;
  void settle(Up scene_up);
  void validate() const;

  bool operator==(const ImageSky&) const = default;
};

}  // namespace radiosity
