// Pictures: pixel by pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/srgb.h"
#include "compare/differences.h"
#include "radiosity/spelling.h"

namespace radiosity {
namespace {

struct Pixel {
  Vec3 value{0.0};  ///< radiance, or linear light without a unit
  bool shown = false;
  bool clipped = false;
};

Pixel pixelOf(const ImageFile& file, LightUnit unit, std::size_t k) {
  const float* rgba = &file.image.rgba[4 * k];
  Pixel pixel{{rgba[0], rgba[1], rgba[2]}, rgba[3] > 0, false};
  if (unit == LightUnit::radiosity) pixel.value *= std::numbers::inv_pi;
  if (unit == LightUnit::srgb8) {
    pixel.clipped = std::max({rgba[0], rgba[1], rgba[2]}) >= kBrightestByte;
    for (int b = 0; b < 3; ++b) {
      pixel.value[b] = linearFromSrgb(std::clamp(double(rgba[b]), 0.0, 1.0));
    }
  }
  return pixel;
}

void requireComparable(const ImageFile& a, LightUnit a_is, const ImageFile& b, LightUnit b_is,
                       const CompareOptions& options) {
  if (a.image.width != b.image.width || a.image.height != b.image.height) {
    throw InputError(fmt::format(
        "A has {} x {} pixels, B {} x {}; render both from the same camera at the same size",
        a.image.width, a.image.height, b.image.width, b.image.height));
  }
  const bool a_coded = a_is == LightUnit::srgb8;
  const bool b_coded = b_is == LightUnit::srgb8;
  if (a_coded == b_coded || options.fit_scale) return;
  throw InputError(fmt::format(
      "{} is tone-mapped (8 bits, for a screen) and {} holds light: render both as .exr; or, if it "
      "has a plain sRGB curve and one exposure, add {}",
      a_coded ? "A" : "B", a_coded ? "B" : "A", spelled("fit_scale")));
}

}  // namespace

Comparison compare(const ImageFile& a, LightUnit a_is, const ImageFile& b, LightUnit b_is,
                   const CompareOptions& options) {
  options.validate();
  requireComparable(a, a_is, b, b_is, options);
  Comparison comparison;
  const std::size_t count = a.image.rgba.size() / 4;
  ValuePairs pairs(count, 3);
  for (std::size_t k = 0; k < count; ++k) {
    const Pixel in_a = pixelOf(a, a_is, k);
    const Pixel in_b = pixelOf(b, b_is, k);
    comparison.area_a += in_a.shown;
    comparison.area_b += in_b.shown;
    if (!in_a.shown || !in_b.shown) continue;
    comparison.matched_a += 1;
    comparison.matched_b += 1;
    if (in_a.clipped || in_b.clipped) {
      comparison.clipped += 1;
      continue;
    }
    const auto width = std::size_t(a.image.width);
    const std::size_t column = k % width;
    const std::size_t row = k / width;
    const Vec3 place(double(column), double(row), 0);
    pairs.weights[k] = {1, place, 0, false};
    for (int c = 0; c < 3; ++c) {
      pairs.ofA(k)[std::size_t(c)] = in_a.value[c];
      pairs.ofB(k)[std::size_t(c)] = in_b.value[c];
    }
  }
  if (comparison.matched_a == comparison.clipped) {
    throw InputError(
        "A and B have no pixel that both show unclipped; render both from the same "
        "camera, and darker where all is clipped");
  }
  measureDifferences(pairs, options, {}, comparison);
  return comparison;
}

}  // namespace radiosity
