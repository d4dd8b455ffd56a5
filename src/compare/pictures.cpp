// Pictures: pixel by pixel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/srgb.h"
#include "compare/differences.h"
#include "compare/perceived.h"
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

/// The mean of each block of `side` x `side` pixels, of those that show something.
Image blockMeans(const Image& image, int side) {
  Image means{image.width / side, image.height / side, {}};
  means.rgba.resize(std::size_t(means.width) * std::size_t(means.height) * 4);
  std::vector<double> sums(means.rgba.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t from = 4 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
      const std::size_t to =
          4 * (std::size_t(y / side) * std::size_t(means.width) + std::size_t(x / side));
      const double alpha = image.rgba[from + 3];
      for (std::size_t c = 0; c < 3; ++c) sums[to + c] += alpha * image.rgba[from + c];
      sums[to + 3] += alpha;
    }
  }
  for (std::size_t k = 0; k < sums.size(); k += 4) {
    if (!(sums[k + 3] > 0)) continue;
    for (std::size_t c = 0; c < 3; ++c) means.rgba[k + c] = float(sums[k + c] / sums[k + 3]);
    means.rgba[k + 3] = float(sums[k + 3] / double(side * side));
  }
  return means;
}

/// How many pixels of `large` a pixel of `small` is wide and high; 0: no whole number, or not the
/// same both ways.
int wholeRatio(const Image& large, const Image& small) {
  if (small.width < 1 || small.height < 1) return 0;
  const int ratio = large.width / small.width;
  return large.width == ratio * small.width && large.height == ratio * small.height ? ratio : 0;
}

/// Makes the larger of two pictures of light as small as the other, if blocks of its pixels are
/// pixels of that.
void alignSizes(Image& a, Image& b, std::vector<Note>& notes) {
  for (const auto& [large, small, name, other] :
       {std::tuple(&a, &b, "A", "B"), std::tuple(&b, &a, "B", "A")}) {
    const int ratio = wholeRatio(*large, *small);
    if (ratio < 2) continue;
    notes.push_back(
        {Severity::info, fmt::format("{} was resampled: means of {} x {} of its {} x {} pixels are "
                                     "compared with pixels of {}",
                                     name, ratio, ratio, large->width, large->height, other)});
    *large = blockMeans(*large, ratio);
    return;
  }
}

/// The values that are compared, as a picture.
Image valuesOf(const ImageFile& file, LightUnit unit) {
  Image image = file.image;
  for (std::size_t k = 0; k < image.rgba.size() / 4; ++k) {
    const Pixel pixel = pixelOf(file, unit, k);
    for (int c = 0; c < 3; ++c) image.rgba[4 * k + std::size_t(c)] = float(pixel.value[c]);
  }
  return image;
}

}  // namespace

Comparison compare(const ImageFile& a_given, LightUnit a_is, const ImageFile& b_given,
                   LightUnit b_is, const CompareOptions& options) {
  options.validate();
  ImageFile a = a_given;
  ImageFile b = b_given;
  Comparison comparison;
  if (a_is != LightUnit::srgb8 && b_is != LightUnit::srgb8) {
    alignSizes(a.image, b.image, comparison.notes);
  }
  requireComparable(a, a_is, b, b_is, options);
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
  if (options.perceived) {
    const bool coded = a_is == LightUnit::srgb8 || b_is == LightUnit::srgb8;
    comparison.perceived =
        perceivedDifference(valuesOf(a, a_is), valuesOf(b, b_is), comparison.scale, coded);
  }
  return comparison;
}

}  // namespace radiosity
