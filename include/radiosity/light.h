// Lights without a surface. A kind is a struct: its traits, its parameters as a list, and what it
// sends to a place; what all others ask of lights, they ask of Light.
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/light_traits.h"
#include "radiosity/option_line.h"
#include "radiosity/photometry.h"
#include "radiosity/sky.h"

namespace [[gnu::visibility("default")]] radiosity {

/// The same radiance from every direction in which nothing stands.
struct UniformSky {
  static constexpr LightTraits kTraits{
      .word = "sky",
      .strength = "radiance",
      .unit = "W/m^2/sr",
      .photometric = "cd/m^2",
      .from = "from where nothing stands",
      .help =
          "Light an open scene from every direction in which nothing stands, also from below: "
          "radiance, W/m^2/sr; one number or R,G,B (default 0). Pictures show it, opaque, "
          "where nothing is hit",
      .single = true};
  static void describe(auto& /*list*/, auto& /*sky*/) {}

  double radiance(double radiance) const { return radiance; }
  std::optional<double> overcast(double radiance) const { return std::numbers::pi * radiance; }

  bool operator==(const UniformSky&) const = default;
};

/// A point that sends the same intensity everywhere.
struct PointLight {
  static constexpr LightTraits kTraits{.word = "point",
                                       .strength = "intensity",
                                       .unit = "W/sr",
                                       .photometric = "cd",
                                       .from = "from a point",
                                       .help = "A point that shines alike in all directions"};
  Vec3 at{0.0};      ///< metres
  double range = 0;  ///< metres, where it ends, by the window of KHR_lights_punctual; 0: nowhere

  static void describe(auto& list, auto& light) {
    describeAt(list, light.at);
    describeRange(list, light.range);
  }

  LightRay ray(const Vec3& place, double u, double v) const;
  /// Of a triangle that faces the point with nothing in between: the mean of its irradiance over
  /// the strength. The solid angle (van Oosterom & Strackee 1983, eq. 8) over the area; none with
  /// a range.
  std::optional<double> share(const Vec3& a, const Vec3& b, const Vec3& c) const;
  /// Over the strength; without the end that `range` makes.
  double power() const { return 4 * std::numbers::pi; }

  bool operator==(const PointLight&) const = default;
};

/// A point that sends a cone of light: the whole intensity up to `inner` degrees off its axis,
/// nothing beyond `outer`, in between the square of a ramp in the cosine (glTF 2.0,
/// KHR_lights_punctual).
struct SpotLight {
  static constexpr LightTraits kTraits{.word = "spot",
                                       .strength = "intensity",
                                       .unit = "W/sr",
                                       .photometric = "cd",
                                       .from = "from a point",
                                       .help = "A point that shines into a cone"};
  Vec3 at{0.0};              ///< metres
  Vec3 aim{0.0, -1.0, 0.0};  ///< metres: a point on its axis, other than `at`
  double inner = 0;          ///< degrees
  double outer = 45;         ///< degrees
  double range = 0;          ///< as of PointLight

  static void describe(auto& list, auto& light) {
    describeAt(list, light.at);
    list({.name = "aim", .value = "X,Y,Z", .unit = "m", .help = "A place that it points at"},
         light.aim);
    list({.name = "inner",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "Up to here off its axis it shines whole"},
         light.inner, {.from = 0, .to = 180});
    list({.name = "outer",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "From here on it does not shine"},
         light.outer, {.to = 180, .above = 0});
    describeRange(list, light.range);
  }

  LightRay ray(const Vec3& place, double u, double v) const;
  double power() const;
  /// Throws InputError unless it has an axis, and an inner cone within the outer.
  void validate() const;

  bool operator==(const SpotLight&) const = default;
};

/// A disc at infinity, in the direction `toward`.
struct Sun : SunPlace {
  static constexpr LightTraits kTraits{
      .word = "sun",
      .strength = "irradiance",
      .unit = "W/m^2",
      .photometric = "lx",
      .from = "from far away",
      .help =
          "Light from far away, with shadows: irradiance of what faces it, W/m^2 (or "
          "100000lx), one number or R,G,B (default 1000), then where it stands: "
          "elevation=DEGREES,azimuth=DEGREES (clockwise from north: +y where z is up, -z where "
          "y is), or toward=X,Y,Z; or LATITUDE,LONGITUDE,TIME, e.g. "
          "52.5,13.4,2026-06-21T12:00+02:00",
      .single = true,
      .usual = 1000};
  double diameter = 0.533;  ///< degrees; 0: sharp shadows

  /// What values are without a name of their own, if one of them is no number.
  static constexpr const char* kUnnamed[] = {"latitude", "longitude", "time"};
  static void describe(auto& list, auto& sun) {
    describePlace(list, sun);
    list({.name = "diameter", .value = "DEGREES", .unit = "degrees", .help = "Of its disc"},
         sun.diameter, {.from = 0, .to = 90});
  }

  /// u and v choose a point of the disc, alike by area.
  bool isWide(const Vec3& /*place*/) const { return diameter > 0; }
  LightRay ray(const Vec3& place, double u, double v) const;
  /// The mean of the cosine over the disc; none where the triangle's plane cuts the disc.
  std::optional<double> share(const Vec3& a, const Vec3& b, const Vec3& c) const;

  bool operator==(const Sun&) const = default;
};

/// A lamp that spreads its flux as a file says. By default it points straight down, and C0 points
/// to +x; where it points elsewhere it is tipped there the shortest way, and straight up about C0.
/// A file of type A or B is of a floodlight: its y, up, stays in the upright plane through the
/// axis, and points to north (+y where z is up, -z where y is) if the lamp points straight down or
/// up.
struct PhotometricLight {
  static constexpr LightTraits kTraits{
      .word = "ies",
      .strength = "flux",
      .unit = "W",
      .photometric = "lm",
      .from = "from a lamp",
      .help = "A lamp of a photometric file, IES LM-63 or EULUMDAT"};
  LampFile file;
  Vec3 at{0.0};             ///< metres: the middle of its luminous opening
  std::optional<Vec3> aim;  ///< metres: a place that it points at; none: straight down
  double turn = 0;          ///< degrees about its axis, from C0 to C90
  std::optional<Vec3> up;   ///< of the scene, unit, which settle() sets; none: y

  static constexpr const char* kUnnamed[] = {"file"};
  static void describe(auto& list, auto& light) {
    list({.name = "file", .value = "LAMP.ies|.ldt", .help = "IES LM-63 or EULUMDAT"}, light.file);
    describeAt(list, light.at);
    list({.name = "aim",
          .value = "X,Y,Z",
          .unit = "m",
          .help = "A place that it points at",
          .unset = "down"},
         light.aim);
    list({.name = "turn",
          .value = "DEGREES",
          .unit = "degrees",
          .help = "About its axis, from C0 to C90"},
         light.turn, {.from = -360, .to = 360});
    list({.name = "up", .value = "X,Y,Z"}, light.up);
  }

  /// x, y and z of the lamp's frame (PhotometryType) in the scene.
  std::array<Vec3, 3> axes() const;
  /// Nearer than ten sizes of its opening. Farther off it is a point, which is off by .25% at most:
  /// by size^2 / (4 distance^2) before a disc that is alike bright (1% at the usual five sizes).
  bool isWide(const Vec3& place) const;
  /// u and v choose a point of the opening, by the area that shows from the place; what it sends is
  /// the intensity over the whole area that shows in that direction.
  LightRay ray(const Vec3& place, double u, double v) const;
  double power() const { return 1; }
  /// W: that of the file.
  double usual() const { return file.flux() / kLumensPerWatt; }
  std::vector<std::string> remarks() const;
  void settle(Up scene_up) {
    if (!up) up = upVector(scene_up);
  }
  /// Throws InputError unless it has a file, and an axis.
  void validate() const;

  bool operator==(const PhotometricLight&) const = default;
};

/// The kinds. Each has
///   kTraits
///   describe(list, kind)     its parameters beside the strength, a line each (option_line.h)
///   operator==
/// and one of
///   radiance(strength)       W/m^2/sr: it comes from where nothing stands, alike all round
///   dome(strength, whole)    the same by direction (sky.h)
///   ray(place, u, v)         it is aimed: the way from a place; u, v in [0, 1)
/// Any may have kUnnamed, validate(), usual() (strength by default), remarks() and settle(up); an
/// aimed one isWide(place) (u and v matter there), share(a, b, c) and power(); one that comes from
/// where nothing stands overcast(strength), and sky.h says what else.
using LightKind = std::variant<UniformSky, PointLight, SpotLight, Sun, PhotometricLight, CieSky,
                               PerezSky, ImageSky>;

struct Light {
  std::string name;
  LightKind kind;
  std::vector<double> strength;  ///< a value for each band, in the unit of traits(); >= 0
  bool photometric = false;      ///< it was given in lm, cd, lx or cd/m^2

  bool operator==(const Light&) const = default;
  const LightTraits& traits() const;
  /// ",NAME=VALUE" of each parameter that is not as by default, and of the name if it is not the
  /// kind's word.
  std::string parametersText() const;
  /// The same for people: a file by its name alone.
  std::string briefText() const;
  /// Those that people give.
  std::vector<std::string> parameterNames() const;
  bool shines() const;  ///< in some band
  /// Whether it comes from where nothing stands: rays that meet nothing bring it (Background).
  bool isAllRound() const;
  bool isUniform() const;  ///< all round, and alike in all directions
  /// W/m^2/sr, of one band; 0 of those that are not uniform.
  double radiance(std::size_t band) const;
  /// W/m^2, of one band, of a place of whose view the share `open` meets nothing: pi L times that,
  /// Lambert's law over a uniform part of the hemisphere. 0 of those that are not uniform.
  double fromAround(std::size_t band, double open) const;
  /// The radiance by direction of one that is all round but not uniform (sky.h); else null.
  Dome dome(bool whole) const;
  /// W/m^2, of one band, of open level ground under it; none: it is no sky, or has a sun in it.
  std::optional<double> overcast(std::size_t band) const;
  /// Of aimed lights; of no share of others.
  LightRay ray(const Vec3& place, double u, double v) const;
  bool isWide(const Vec3& place) const;  ///< there are several ways to the place
  /// The mean over a triangle that faces it, nothing in between, of irradiance over the strength;
  /// none: there is no closed form.
  std::optional<double> share(const Vec3& a, const Vec3& b, const Vec3& c) const;
  /// W, of one band; none: it has no end.
  std::optional<double> power(std::size_t band) const;
  std::optional<Vec3> place() const;  ///< none: it has none in the scene
  std::string fileName() const;       ///< of the file that it is made from; empty: of none
  /// What a user should know of it, a line each.
  std::vector<std::string> remarks() const;
  /// Whether it comes from beyond the scene.
  bool isFromOutside() const;
  /// What depends on the scene that it stands in; readers and applyOverrides() do it, and then
  /// settleSkies().
  void settle(Up up);
  /// Its option, as its face spells it: --sky, --light point.
  std::string option() const;
  /// Throws InputError unless strengths are finite and >= 0, and parameters in range.
  void validate() const;
};

/// Named "sky".
Light uniformSky(std::vector<double> radiance);

/// A light of each kind as it is by default, named by its word, of no bands.
std::vector<Light> lightKinds();

/// The light of a kind as the command line has it: its strength, one number or one a band, then
/// NAME=VALUE of its parameters, with commas: "1,2,3,elevation=45", "intensity=800cd,at=1,2,2.5,
/// name=desk". The unit is that of the traits, the photometric one, or W or lm of a light that has
/// a power. Errors: InputError.
Light lightOf(const std::string& word, const std::string& text, int bands = 3);
/// The same, the kind's word before the rest: "point,800cd,at=1,2,2.5".
Light lightOf(const std::string& text);

/// Whether light is told in lux beside W/m^2: a light that shines was given so.
bool arePhotometric(std::span<const Light> lights);
bool anyShines(std::span<const Light> lights);
/// Whether one that shines comes from beyond the scene.
bool anyShinesIn(std::span<const Light> lights);
/// The radiance of what is seen where nothing stands, a band each, of the lights that are uniform;
/// empty: of no light.
std::vector<double> background(std::span<const Light> lights, int bands);
/// Those that shine and are all round, but not uniform.
std::vector<Light> unevenSkies(std::span<const Light> lights);
/// What rays do not find: those that shine and are aimed, and the bright spots of skies.
std::vector<Light> aimedLights(std::span<const Light> lights);
/// Tells each sky where the sun of the scene stands, and how it lights the ground. Errors:
/// InputError for a sky that needs a sun where there is none, or several.
void settleSkies(std::span<Light> lights, Up up);
/// Replaces the light of that name, if there is one.
void setLight(std::vector<Light>& lights, Light light);
/// The same for a light that was not given a name: one of its own, "point 2", if its kind may be
/// there more than once. Errors: InputError for a given name that another has.
void addLight(std::vector<Light>& lights, Light light);

/// What is seen where nothing stands, of all lights that are all round.
class Background {
 public:
  Background() = default;
  /// `whole`: with the bright spots that are aimed lights to rays (aimedLights()).
  Background(std::span<const Light> lights, int bands, bool whole = false);

  std::size_t bands() const { return bands_; }
  bool empty() const { return uniform_.empty() && domes_.empty(); }
  /// Adds `times` the radiance in a direction, unit, W/m^2/sr, a value a band.
  void add(const Vec3& toward, double times, std::span<double> sum) const;

 private:
  std::size_t bands_ = 0;
  std::vector<double> uniform_;  ///< a value a band, or empty: it is dark
  std::vector<Dome> domes_;
};

}  // namespace radiosity
