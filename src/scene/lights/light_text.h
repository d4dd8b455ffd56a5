// Lights as files and keys have them: the sky as it stood there before there were other lights, and
// those as texts.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "radiosity/light.h"

namespace radiosity {

/// A name within a light's text: %xx for what separates the parts of one.
std::string encodedText(std::string_view name);
/// The inverse.
std::string decodedText(std::string_view text);
/// Empty: there is no sky.
std::vector<double> skyRadiance(std::span<const Light> lights);
/// "NAME=TEXT" of each light that is not the sky; TEXT as lightOf() takes it.
std::vector<std::string> otherLights(std::span<const Light> lights);
/// The inverse of these two.
std::vector<Light> lightsOf(const std::vector<double>& sky, std::span<const std::string> others,
                            int bands);
/// For people: where a light stands that is not everywhere: "at 1,2,2.5", "35 degrees above the
/// horizon, azimuth 160".
std::string standText(const Light& light, Up up);
/// Of the direction to a sun.
SolarPosition standingOf(const Vec3& toward, Up up);
/// One number if all bands have the same; "0" of none.
std::string strengthText(std::span<const double> strength);

}  // namespace radiosity
