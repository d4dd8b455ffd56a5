#include "compare/perceived.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/luminance.h"
#include "base/srgb.h"
#include "compare/flip.h"
#include "compare/similarity.h"

namespace radiosity {
namespace {

ColourPlane coloursOf(const Image& image, const Image& other, double scale) {
  ColourPlane plane{image.width, image.height, std::vector<Vec3>(image.rgba.size() / 4)};
  for (std::size_t k = 0; k < plane.pixels.size(); ++k) {
    const float* c = &image.rgba[4 * k];
    if (c[3] > 0 && other.rgba[4 * k + 3] > 0) plane.pixels[k] = scale * Vec3(c[0], c[1], c[2]);
  }
  return plane;
}

/// Luminance as a screen shows it, sRGB-coded.
Plane greyOf(const ColourPlane& colours, double factor) {
  Plane grey{colours.width, colours.height, {}};
  grey.values.reserve(colours.pixels.size());
  for (const Vec3& c : colours.pixels) {
    grey.values.push_back(srgbFromLinear(std::clamp(factor * luminanceOf(c), 0.0, 1.0)));
  }
  return grey;
}

}  // namespace

PerceivedDifference perceivedDifference(const Image& a, const Image& b, double scale, bool coded) {
  const ColourPlane of_a = coloursOf(a, b, 1);
  const ColourPlane of_b = coloursOf(b, a, scale);
  const Plane flip = coded ? flipOfShown(of_a, of_b) : flipOfLight(of_a, of_b);
  PerceivedDifference seen;
  seen.flip =
      std::accumulate(flip.values.begin(), flip.values.end(), 0.0) / double(flip.values.size());
  if (!coded) seen.exposure_ev = autoExposure(a);
  const double factor = seen.exposure_ev ? std::exp2(*seen.exposure_ev) : 1;
  seen.ssim = structuralSimilarity(greyOf(of_a, factor), greyOf(of_b, factor));
  return seen;
}

}  // namespace radiosity
