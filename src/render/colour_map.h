// Numbers in [0, 1] as colours.
#pragma once

#include <array>

#include "base/luminance.h"
#include "radiosity/base.h"

namespace radiosity {

/// Viridis: perceptually uniform, lightness rising steadily, readable with colour-deficient eyes
/// and in grey (S. van der Walt & N. Smith, 2015, in the public domain as CC0).
class ColourMap {
 public:
  ColourMap();
  /// Linear RGB; t outside [0, 1] gets the colour of the nearer end.
  Vec3 at(double t) const;

 private:
  static constexpr int kSteps = 256;
  std::array<Vec3, kSteps + 1> table_;  ///< linear RGB, so that at() takes no powers
};

/// Display value of text and lines over a colour: black, or white over a dark one.
inline float inkOver(const Vec3& linear_rgb) {
  constexpr double kBright = 0.2;
  return luminanceOf(linear_rgb) < kBright ? 1.0F : 0.0F;
}

}  // namespace radiosity
