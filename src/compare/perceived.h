// How different two pictures look to people.
#pragma once

#include "radiosity/compare.h"

namespace radiosity {

/// Two pictures of one size. `scale`: of B. Where either shows nothing, both are black. `coded`:
/// made for a screen (LightUnit::srgb8), with `a` and `b` decoded to linear values.
PerceivedDifference perceivedDifference(const Image& a, const Image& b, double scale, bool coded);

}  // namespace radiosity
