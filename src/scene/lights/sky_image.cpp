// Skies of images.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "base/hash.h"
#include "base/luminance.h"
#include "base/printable.h"
#include "radiosity/light.h"
#include "scene/lights/light_text.h"
#include "scene/texture.h"

namespace radiosity {

namespace {

constexpr char kBetween = '|';
constexpr double kMostMegapixels = 100;
/// What is brighter than this many means of all that is not is a bright spot: some hundred rays
/// that find it by chance are then off by no more than by the rest.
constexpr double kSpot = 8;

/// Of a texel of that row.
double solidAngle(const SkyImage::Texels& texels, std::size_t row) {
  const double step = std::numbers::pi / texels.height;
  const double heights = std::cos(double(row) * step) - std::cos(double(row + 1) * step);
  return heights * 2 * std::numbers::pi / texels.width;
}

std::vector<float> luminancesOf(const SkyImage::Texels& texels) {
  std::vector<float> luminances(texels.rgb.size() / 3);
  for (std::size_t k = 0; k < luminances.size(); ++k) {
    const float* rgb = &texels.rgb[3 * k];
    luminances[k] = float(luminanceOf({rgb[0], rgb[1], rgb[2]}));
  }
  return luminances;
}

/// The luminance above which texels are bright spots: kSpot times the mean of what is below it
/// everywhere. Each step comes down to it from above.
double spotLuminance(const SkyImage::Texels& texels, std::span<const float> luminances) {
  double bound = *std::ranges::max_element(luminances);
  constexpr int kMostSteps = 100;
  for (int step = 0; step < kMostSteps; ++step) {
    double sum = 0;
    for (std::size_t k = 0; k < luminances.size(); ++k) {
      sum += solidAngle(texels, k / std::size_t(texels.width)) *
             std::min(bound, double(luminances[k]));
    }
    const double next = kSpot * sum / (4 * std::numbers::pi);
    if (!(next < 0.999 * bound)) break;
    bound = next;
  }
  return bound;
}

void findSpots(SkyImage::Texels& texels) {
  const std::vector<float> luminances = luminancesOf(texels);
  const double bound = spotLuminance(texels, luminances);
  double until = 0;
  Vec3 colour(0.0);
  for (std::size_t k = 0; k < luminances.size(); ++k) {
    if (!(luminances[k] > bound)) continue;
    const double kept = bound / luminances[k];
    const double angle = solidAngle(texels, k / std::size_t(texels.width));
    if (texels.kept.empty()) texels.kept.assign(luminances.size(), 1.0F);
    texels.kept[k] = float(kept);
    const float* rgb = &texels.rgb[3 * k];
    colour += (1 - kept) * angle * Vec3(rgb[0], rgb[1], rgb[2]);
    until += (1 - kept) * angle * luminances[k];
    texels.spots.push_back({std::uint32_t(k), until});
  }
  if (until > 0) texels.spot_colour = colour / until;
}

/// A direction's place in an image and back.
class Orientation {
 public:
  explicit Orientation(const ImageSky& sky)
      : up_(sky.up.value_or(Vec3(0, 1, 0))),
        north_(up_.z > 0.5 ? Vec3(0, 1, 0) : Vec3(0, 0, -1)),
        turn_(sky.turn / 360 + 0.5) {}

  /// From the left and from the top, 0 to 1.
  Vec2 placeOf(const Vec3& toward) const {
    const double across = std::atan2(toward.x, glm::dot(toward, north_)) / (2 * std::numbers::pi);
    const double x = across - turn_ + 1;
    const double height = std::clamp(glm::dot(up_, toward), -1.0, 1.0);
    return {x - std::floor(x), std::acos(height) / std::numbers::pi};
  }
  /// `height`: the sine above the horizon.
  Vec3 directionAt(double x, double height) const {
    const double angle = 2 * std::numbers::pi * (x + turn_);
    const double level = std::sqrt(std::max(0.0, 1 - height * height));
    return height * up_ + level * (std::sin(angle) * Vec3(1, 0, 0) + std::cos(angle) * north_);
  }

 private:
  Vec3 up_;
  Vec3 north_;
  double turn_;
};

void requireColours(std::size_t bands) {
  if (bands == 1 || bands % 3 == 0) return;
  throw InputError(
      fmt::format("image-sky: an image has red, green and blue, or one band of grey, "
                  "not {} bands",
                  bands));
}

}  // namespace

std::string SkyImage::optionText() const {
  return empty() ? "" : encodedText(path_) + kBetween + hash_;
}

bool SkyImage::readOption(std::string_view text) {
  path_ = decodedText(text.substr(0, text.find(kBetween)));
  if (path_.empty()) return false;
  TextureResult read = readTexture(path_, kMostMegapixels);
  if (!read.problem.empty()) {
    throw InputError(fmt::format("{}: the image of the sky {}", printable(path_), read.problem));
  }
  auto texels = std::make_shared<Texels>();
  texels->width = read.texture.width;
  texels->height = read.texture.height;
  texels->rgb = std::move(read.texture.texels);
  if (texels->width != 2 * texels->height) {
    throw InputError(fmt::format(
        "{}: has {} x {} pixels; an equirectangular image is twice as wide as it is high",
        printable(path_), texels->width, texels->height));
  }
  Hash hash;
  hash.array(texels->rgb);
  hash_ = hash.hex();
  findSpots(*texels);
  texels_ = std::move(texels);
  return true;
}

Dome ImageSky::dome(std::span<const double> strength, bool whole) const {
  requireColours(strength.size());
  return [image = file, orientation = Orientation(*this), whole,
          strength = std::vector<double>(strength.begin(), strength.end())](
             const Vec3& toward, double times, std::span<double> sum) {
    const SkyImage::Texels& texels = image.texels();
    const Vec2 place = orientation.placeOf(toward);
    const int x = std::min(int(place.x * texels.width), texels.width - 1);
    const int y = std::min(int(place.y * texels.height), texels.height - 1);
    const std::size_t k = std::size_t(y) * std::size_t(texels.width) + std::size_t(x);
    const float* rgb = &texels.rgb[3 * k];
    const double each = whole || texels.kept.empty() ? times : times * texels.kept[k];
    const bool grey = sum.size() == 1;
    for (std::size_t b = 0; b < sum.size(); ++b) {
      sum[b] +=
          each * strength[b] * (grey ? luminanceOf({rgb[0], rgb[1], rgb[2]}) : double(rgb[b % 3]));
    }
  };
}

LightRay ImageSky::ray(const Vec3& /*place*/, double u, double v) const {
  const SkyImage::Texels& texels = file.texels();
  if (texels.spots.empty()) return {};
  const double whole = texels.spots.back().until;
  auto spot = std::ranges::upper_bound(texels.spots, u * whole, {}, &SkyImage::Spot::until);
  if (spot == texels.spots.end()) --spot;
  const double before = spot == texels.spots.begin() ? 0.0 : (spot - 1)->until;
  const double down = std::clamp((u * whole - before) / (spot->until - before), 0.0, 1.0);
  const double step = std::numbers::pi / texels.height;
  const std::size_t row = spot->texel / std::size_t(texels.width);
  const double top = std::cos(double(row) * step);
  const double bottom = std::cos(double(row + 1) * step);
  const double x = (double(spot->texel % std::size_t(texels.width)) + v) / texels.width;
  return {Orientation(*this).directionAt(x, top + down * (bottom - top)), LightRay::kOutside,
          whole};
}

double ImageSky::ofSpots(std::size_t band, std::size_t bands) const {
  requireColours(bands);
  if (file.empty() || file.texels().spots.empty()) return 0;
  const Vec3& colour = file.texels().spot_colour;
  return bands == 1 ? 1.0 : colour[int(band % 3)];
}

void ImageSky::settle(Up scene_up) {
  if (!up) up = upVector(scene_up);
}

void ImageSky::validate() const {
  if (file.empty()) throw InputError("image-sky: has no image; give file=SKY.hdr or SKY.exr first");
}

}  // namespace radiosity
