#include "scene/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>
#include <utility>
#include <vector>

#include "base/image_codec.h"
#include "base/input_file.h"
#include "base/srgb.h"
#include "radiosity/spelling.h"
#include "scene/text.h"

namespace radiosity {

namespace {

TextureResult withProblem(std::string problem) {
  TextureResult result;
  result.problem = std::move(problem);
  return result;
}

/// The inverse of the sRGB curve. It is kept for the samples that came last: an image of integers
/// has few different ones.
class LinearSamples {
 public:
  float operator()(float coded) {
    const double place = std::clamp(double(coded), 0.0, 1.0) * double(kept_.size() - 1);
    Kept& kept = kept_[std::size_t(std::lround(place))];
    if (kept.coded != coded) kept = {coded, float(linearFromSrgb(coded))};
    return kept.linear;
  }

 private:
  struct Kept {
    float coded = std::numeric_limits<float>::quiet_NaN();  // equals no sample
    float linear = 0;
  };
  std::vector<Kept> kept_ = std::vector<Kept>(4096);  // samples of 8 bits have a place each
};

TextureResult textureFrom(const DecodedImage& image, const std::string& name) {
  TextureResult result;
  if (!image.too_large.empty()) {
    result.problem = image.too_large;
    return result;
  }
  if (image.width < 1 || image.height < 1 || image.channels < 1) {
    result.problem = "holds no pixels";
    return result;
  }
  if (!image.problem.empty()) {
    result.problem = "cannot be decoded (" + onOneLine(image.problem) + ")";
    return result;
  }
  const auto channels = std::size_t(image.channels);
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  Texture& texture = result.texture;
  texture.name = name;
  texture.width = image.width;
  texture.height = image.height;
  texture.texels.resize(pixels * 3);
  result.has_alpha = channels == 2 || channels == 4;
  // Integer samples are for display and have the sRGB curve.
  const bool encoded = !image.floating && !image.linear;
  LinearSamples linear;
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t band = 0; band < 3; ++band) {
      const float sample = image.samples[p * channels + (channels >= 3 ? band : 0)];
      texture.texels[p * 3 + band] = encoded ? linear(sample) : sample;
    }
  }
  const bool usable = std::all_of(texture.texels.begin(), texture.texels.end(),
                                  [](float t) { return t >= 0.0f && std::isfinite(t); });
  if (!usable) result.problem = "has texels that are negative or not finite";
  result.above_one =
      std::any_of(texture.texels.begin(), texture.texels.end(), [](float t) { return t > 1.0f; });
  return result;
}

/// read(), with exceptions of libraries turned into results.
template <class Read>
TextureResult decoded(const std::string& name, const Read& read) {
  try {
    const DecodedImage image = read();
    if (!image.opened) return withProblem("cannot be decoded (" + onOneLine(image.problem) + ")");
    return textureFrom(image, name);
  } catch (const std::bad_alloc&) {
    throw RunError(fmt::format("{}: the image does not fit into memory; make it smaller", name));
  }
}

}  // namespace

std::string LoadedTexture::problemAs(TextureUse use) const {
  if (!problem.empty() || use == TextureUse::emission || !above_one) return problem;
  return "has texels above 1, which are no reflectances";
}

void noteUnusedTexture(const std::string& file, const std::string& problem, TextureUse use,
                       const char* what, const std::string& material, FeatureNotes& notes) {
  const bool emits = use == TextureUse::emission;
  const Severity severity = emits ? Severity::loud : Severity::warning;
  const char* const texture = emits ? "emission texture" : "texture";
  const std::string then = emits ? fmt::format("it EMITS NOTHING ({} gives it one all over)",
                                               spelled("set", "NAME.radiance"))
                                 : fmt::format("the {} alone counts", what);
  if (problem != kImageMissing) {
    notes.add(fmt::format("{} {} {}; {}, material", texture, file, problem, then), material,
              severity);
    return;
  }
  constexpr std::size_t kShown = 4;  // with their paths
  notes.add(fmt::format("{}s that are not there; {}, material", texture, then),
            fmt::format("{} ({})", material, file), severity, kShown);
}

LoadedTexture keepTexture(TextureResult result, bool repeat, Scene& scene) {
  LoadedTexture loaded;
  loaded.problem = result.problem;
  loaded.above_one = result.above_one;
  if (!loaded.problem.empty()) return loaded;
  result.texture.repeat = repeat;
  loaded.index = Index(scene.textures.size());
  scene.textures.push_back(std::move(result.texture));
  return loaded;
}

TextureResult readTexture(const std::string& path, double max_image) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return withProblem(kImageMissing);
  const std::string why = whyNotAFile(path);
  if (!why.empty()) return withProblem(why);
  return decoded(path, [&] { return imageCodec().read(path, {max_image * 1e6}); });
}

TextureResult decodeTexture(const std::string& name, std::span<const unsigned char> bytes,
                            double max_image) {
  return decoded(name, [&] { return imageCodec().decode(name, bytes, {max_image * 1e6}); });
}

}  // namespace radiosity
