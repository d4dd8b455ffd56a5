// Lights without a surface. A kind is a struct: its traits, its parameters as a list, and what it
// gives to a place; what all others ask of lights, they ask of Light.
#pragma once

#include <span>
#include <string>
#include <variant>
#include <vector>

#include "radiosity/base.h"
#include "radiosity/option_line.h"

namespace [[gnu::visibility("default")]] radiosity {

/// A place that lights shine on.
struct LitPlace {
  Vec3 position{0.0};  ///< metres
  Vec3 normal{0.0};
  /// The share of what leaves the place that meets nothing. 0 where rays ask each light for the
  /// radiance that they bring (Light::radiance()).
  double open = 0;
};

/// What a kind of light is called.
struct LightTraits {
  const char* word;      ///< of the command line, Python and files; the name of the light
  const char* strength;  ///< the quantity that scales it
  const char* unit;      ///< of the strength
  const char* from;      ///< where it comes from, in a few words
  const char* help;      ///< a sentence
};

/// The same radiance from every direction in which nothing stands.
struct UniformSky {
  static constexpr LightTraits kTraits{
      "sky", "radiance", "W/m^2/sr", "from where nothing stands",
      "Light an open scene from every direction in which nothing stands, also from below: "
      "radiance, W/m^2/sr; one number or R,G,B (default 0). Pictures show it, opaque, where "
      "nothing is hit"};
  static void describe(auto& /*list*/, auto& /*sky*/) {}

  /// pi L times the open share: Lambert's law over a uniform part of the hemisphere.
  double irradiance(double radiance, const LitPlace& place) const;
  double radiance(double radiance) const { return radiance; }

  bool operator==(const UniformSky&) const = default;
};

/// The kinds. Each has
///   kTraits
///   describe(list, kind)          its parameters beside the strength, a line each (option_line.h)
///   irradiance(strength, place)   W/m^2
///   radiance(strength)            if it comes from where nothing stands: W/m^2/sr
///   operator==
using LightKind = std::variant<UniformSky>;

struct Light {
  std::string name;
  LightKind kind;
  std::vector<double> strength;  ///< a value for each band, in the unit of traits(); >= 0

  const LightTraits& traits() const;
  /// ",NAME=VALUE" of each parameter.
  std::string parametersText() const;
  bool shines() const;  ///< in some band
  /// Whether it comes from where nothing stands: rays that meet nothing bring its radiance().
  bool isAllRound() const;
  /// W/m^2, of one band.
  double irradiance(std::size_t band, const LitPlace& place) const;
  /// W/m^2/sr, of one band; 0 of lights that are not all round.
  double radiance(std::size_t band) const;
  /// Throws InputError unless strengths are finite and >= 0, and parameters in range.
  void validate() const;
};

/// Named "sky".
Light uniformSky(std::vector<double> radiance);

/// A light of each kind as it is by default, named by its word, of no bands.
std::vector<Light> lightKinds();

/// The light of a kind as the command line has it: its strength, one number or one a band, then
/// NAME=VALUE of its parameters, with commas: "1,2,3,elevation=45". Errors: InputError.
Light lightOf(const std::string& word, const std::string& text, int bands = 3);

bool anyShines(std::span<const Light> lights);
/// The radiance of what is seen where nothing stands, a band each; empty: of no light.
std::vector<double> background(std::span<const Light> lights, int bands);
/// Those that shine and are not all round: rays do not find them.
std::vector<Light> aimedLights(std::span<const Light> lights);
/// Replaces the light of that name, if there is one.
void setLight(std::vector<Light>& lights, Light light);

}  // namespace radiosity
