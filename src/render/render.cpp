// Draws a field: every pixel is the mean of the samples that hit a surface.
#include "radiosity/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/luminance.h"
#include "base/option_list.h"
#include "render/draw.h"

namespace radiosity {
namespace {

using Colour = std::array<double, 3>;

/// The parts of a pixel, while its samples come.
class PixelParts {
 public:
  explicit PixelParts(PictureParts* parts) : parts_(parts) {}

  void begin() { sums_ = {}; }
  void add(const Shade& shade) {
    for (int b = 0; b < 3; ++b) {
      sums_.direct[b] += shade.direct[b];
      sums_.albedo[b] += shade.albedo[b];
    }
    sums_.light += shade.light;
    sums_.noise_square += shade.noise_square;
  }
  /// `mean`: the colour of the pixel, over `hits` of `samples` samples.
  void end(std::size_t pixel, const Colour& mean, int hits, int samples) {
    if (parts_ == nullptr) return;
    for (std::size_t b = 0; b < 3; ++b) {
      const double direct = sums_.direct[b] / samples;
      parts_->direct[3 * pixel + b] = float(direct);
      parts_->indirect[3 * pixel + b] = float(mean[b] * hits / samples - direct);
      parts_->albedo[3 * pixel + b] = float(sums_.albedo[b] / hits);
    }
    if (!parts_->error.empty() && sums_.light > 0) {
      parts_->error[pixel] = float(std::sqrt(sums_.noise_square) / sums_.light);
    }
  }

 private:
  PictureParts* parts_;
  Shade sums_;
};

/// Colour: the mean over the samples that hit a surface or a background. Alpha: the share of these
/// samples. The mean is that of differences to the first hit, so that a constant field keeps its
/// bits.
class RgbPixel {
 public:
  RgbPixel(Image& image, const Background& background, PictureParts* parts)
      : image_(image), background_(background), parts_(parts) {}

  void begin() {
    hits_ = samples_ = 0;
    sum_ = {};
    parts_.begin();
  }
  void sample(Seen seen, const Shade& shade) {
    ++samples_;
    Shade shown;
    if (seen == Seen::front) {
      shown = shade;
    } else if (seen == Seen::nothing) {
      if (background_.empty()) return;
      shown = beyond(shade.value);
    }
    if (hits_++ == 0) first_ = shown.value;
    for (int b = 0; b < 3; ++b) sum_[b] += shown.value[b] - first_[b];
    parts_.add(shown);
  }
  void end(int x, int y) {
    if (hits_ == 0) return;
    Colour mean{};
    for (int b = 0; b < 3; ++b) mean[b] = first_[b] + sum_[b] / hits_;
    const std::size_t pixel = std::size_t(y) * image_.width + x;
    float* out = image_.rgba.data() + pixel * 4;
    for (int b = 0; b < 3; ++b) out[b] = float(mean[b]);
    out[3] = float(hits_) / float(samples_);
    parts_.end(pixel, mean, hits_, samples_);
  }

 private:
  /// What is seen where nothing stands.
  Shade beyond(const Colour& direction) const {
    Shade shade;
    const std::size_t bands = background_.bands();
    background_.add({direction[0], direction[1], direction[2]}, 1,
                    std::span(shade.value).first(bands));
    if (bands == 1) shade.value.fill(shade.value[0]);
    shade.direct = shade.value;
    return shade;
  }

  Image& image_;
  const Background& background_;
  PixelParts parts_;
  int hits_ = 0;
  int samples_ = 0;
  Colour first_{};
  Colour sum_{};
};

Image draw(const PatchMesh& mesh, const PatchField& field, const Camera& camera,
           const RenderOptions& options, Progress& progress, PictureParts* parts = nullptr) {
  const View view = makeView(camera, options.width, options.height);
  const ItemBuffer items(mesh, view, options.samples, options.show_backs);
  return drawField(mesh, field, items, options, "picture", progress, parts);
}

void requireColours(const PatchMesh& mesh, std::span<const double> values) {
  if (values.size() == 3 * mesh.size()) return;
  throw InputError(fmt::format(
      "render: a picture draws three bands, so {} patches need {} values, {} were given; "
      "make colours of other bands, of one by rgbOf()",
      mesh.size(), 3 * mesh.size(), values.size()));
}

void checkCorners(const PatchMesh& mesh, std::span<const double> corners) {
  if (corners.size() != 3 * mesh.corners.size()) {
    throw InputError(fmt::format("render: {} values at corners are needed, {} were given",
                                 3 * mesh.corners.size(), corners.size()));
  }
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (std::isfinite(corners[k])) continue;
    throw InputError(fmt::format("render: the value at vertex {} is {}, not a finite number",
                                 mesh.corners[k / 3], corners[k]));
  }
}

}  // namespace

Image drawField(const PatchMesh& mesh, const PatchField& field, const ItemBuffer& items,
                const RenderOptions& options, const std::string& stage, Progress& progress,
                PictureParts* parts) {
  Image image{options.width, options.height, {}};
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  image.rgba.assign(pixels * 4, 0.0f);
  if (parts != nullptr) {
    for (auto* part : {&parts->direct, &parts->indirect, &parts->albedo})
      part->assign(3 * pixels, 0);
    const bool has_error = field.roots != nullptr && field.roots->points != nullptr;
    parts->error.assign(has_error ? pixels : 0, 0);
  }
  progress.begin(stage, items.tileCount());
  forSamples(
      mesh, items, field, [&](std::size_t) { return RgbPixel(image, options.background, parts); },
      progress);
  progress.end();
  return image;
}

std::vector<double> radianceOf(std::span<const double> exitance) {
  std::vector<double> out(exitance.begin(), exitance.end());
  for (double& value : out) value *= std::numbers::inv_pi;
  return out;
}

void RenderOptions::validate() const { requireRanges(*this); }

PatchField makeField(const PatchMesh& mesh, std::span<const double> values, int bands,
                     const RenderOptions& options) {
  if (values.size() != mesh.size() * std::size_t(bands)) {
    throw InputError(
        fmt::format("render: {} values a patch are needed, {} were given for {} patches", bands,
                    values.size(), mesh.size()));
  }
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isfinite(values[k])) continue;
    throw InputError(fmt::format("render: the value of patch {} is {}, not a finite number",
                                 k / bands, values[k]));
  }
  PatchField field;
  field.values = values;
  field.bands = bands;
  if (options.smooth) field.corners = cornerValues(mesh, values, bands, options.crease);
  return field;
}

std::vector<double> rgbOf(std::span<const double> values, int bands) {
  if (bands == 3) return {values.begin(), values.end()};
  if (bands != 1) {
    throw InputError(
        fmt::format("a picture draws three bands (red, green, blue), or one in grey, not {}; pick "
                    "one or three of them, or make colours of them",
                    bands));
  }
  std::vector<double> grey;
  grey.reserve(3 * values.size());
  for (const double value : values) grey.insert(grey.end(), 3, value);
  return grey;
}

Image render(const PatchMesh& mesh, std::span<const double> values, const Camera& camera,
             const RenderOptions& options, Progress& progress) {
  options.validate();
  requireColours(mesh, values);
  return draw(mesh, makeField(mesh, values, 3, options), camera, options, progress);
}

Image render(const PatchMesh& mesh, std::span<const double> values, std::span<const double> corners,
             const Camera& camera, const RenderOptions& options, Progress& progress) {
  options.validate();
  requireColours(mesh, values);
  checkCorners(mesh, corners);
  RenderOptions constant = options;
  constant.smooth = false;
  PatchField field = makeField(mesh, values, 3, constant);
  if (options.smooth) field.corners.assign(corners.begin(), corners.end());
  return draw(mesh, field, camera, options, progress);
}

Image renderRadiance(const PatchMesh& mesh, std::span<const double> radiosity,
                     std::span<const double> corners, const Camera& camera,
                     const RenderOptions& options, Progress& progress) {
  if (corners.empty()) return render(mesh, radianceOf(radiosity), camera, options, progress);
  return render(mesh, radianceOf(radiosity), radianceOf(corners), camera, options, progress);
}

std::vector<double> reflectedLight(std::span<const double> radiosity,
                                   const PatchMaterials& materials) {
  const auto bands = std::size_t(materials.bands);
  std::vector<double> reflected;
  reflected.reserve(radiosity.size() / bands);
  std::vector<double> apart(bands);
  for (std::size_t k = 0; k < radiosity.size(); k += bands) {
    for (std::size_t b = 0; b < bands; ++b) {
      apart[b] = radiosity[k + b] - materials.emission[k + b];
    }
    reflected.push_back(std::max(0.0, brightnessOf(apart)));
  }
  return reflected;
}

SurfaceLight surfaceLight(std::span<const double> radiosity, const PatchMaterials& materials) {
  SurfaceLight light;
  light.patches = rgbOf(radiosity, materials.bands);
  light.reflected = reflectedLight(radiosity, materials);
  light.sky = Background(materials.lights, materials.bands, true);
  return light;
}

std::vector<std::uint8_t> visiblePatches(const PatchMesh& mesh, const Camera& camera,
                                         const RenderOptions& options, Progress& progress) {
  options.validate();
  const View view = makeView(camera, options.width, options.height);
  const ItemBuffer items(mesh, view, options.samples, options.show_backs);
  std::vector<std::atomic<std::uint8_t>> seen(mesh.size());
  parallelFor(std::size_t(items.tileCount()), 1, [&](std::size_t tile) {
    if (progress.cancelled()) return;
    thread_local TileItems samples;
    items.resolve(int(tile), samples);
    Index last = kNone;
    for (const Index piece : samples.piece) {
      if (piece == last || piece == kNone) continue;
      last = piece;
      if (!items.seenFromBehind(piece)) {
        seen[items.patchOf(piece)].store(1, std::memory_order_relaxed);
      }
    }
  });
  progress.check();
  return {seen.begin(), seen.end()};
}

SurfaceLight fallingLight(SurfaceLight light, std::span<const double> irradiance, int bands) {
  light.patches = rgbOf(irradiance, bands);
  light.corners.clear();
  light.sky = {};
  light.reflectance.assign(irradiance.size(), 1.0);
  light.emission.assign(irradiance.size(), 0.0);
  light.materials.reset();
  return light;
}

Image renderRadiance(const PatchMesh& mesh, const SurfaceLight& light, const Camera& camera,
                     const RenderOptions& options, Progress& progress, PictureParts* parts) {
  RenderOptions with_sky = options;
  if (!light.sky.empty()) with_sky.background = light.sky;
  if (light.elements && options.smooth) {
    with_sky.validate();
    const std::vector<double> radiance = radianceOf(light.patches);
    requireColours(mesh, radiance);
    PatchField field = makeField(mesh, radiance, 3, with_sky);
    const ElementLookup lookup(mesh, light.elements->roots);
    ShadedRoots shaded{light.elements->roots, light.elements->bands, light.reflectance,
                       light.emission, std::numbers::inv_pi};
    shaded.elements = light.elements.get();
    shaded.lookup = &lookup;
    shaded.materials = light.materials.get();
    field.roots = &shaded;
    return draw(mesh, field, camera, with_sky, progress, parts);
  }
  if (parts != nullptr) {
    throw InputError(
        "layers: patches do not tell direct from indirect light; draw the light of elements, "
        "smoothly, or gather it at every pixel");
  }
  return renderRadiance(mesh, light.patches, light.corners, camera, with_sky, progress);
}

}  // namespace radiosity
