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

/// Colour: the mean over the samples that hit a surface or a background. Alpha: the share of these
/// samples. The mean is that of differences to the first hit, so that a constant field keeps its
/// bits.
class RgbPixel {
 public:
  RgbPixel(Image& image, const std::optional<Vec3>& background) : image_(image) {
    if (background) background_ = {background->x, background->y, background->z};
  }

  void begin() {
    hits_ = samples_ = 0;
    sum_ = {};
  }
  void sample(Seen seen, const std::array<double, 3>& value) {
    ++samples_;
    std::array<double, 3> colour{};
    if (seen == Seen::front) {
      colour = value;
    } else if (seen == Seen::nothing) {
      if (!background_) return;
      colour = *background_;
    }
    if (hits_++ == 0) first_ = colour;
    for (int b = 0; b < 3; ++b) sum_[b] += colour[b] - first_[b];
  }
  void end(int x, int y) {
    if (hits_ == 0) return;
    float* out = image_.rgba.data() + (std::size_t(y) * image_.width + x) * 4;
    for (int b = 0; b < 3; ++b) out[b] = float(first_[b] + sum_[b] / hits_);
    out[3] = float(hits_) / float(samples_);
  }

 private:
  Image& image_;
  std::optional<std::array<double, 3>> background_;
  int hits_ = 0;
  int samples_ = 0;
  std::array<double, 3> first_{};
  std::array<double, 3> sum_{};
};

Image draw(const PatchMesh& mesh, const PatchField& field, const Camera& camera,
           const RenderOptions& options, Progress& progress) {
  const View view = makeView(camera, options.width, options.height);
  const ItemBuffer items(mesh, view, options.samples, options.show_backs);
  return drawField(mesh, field, items, options, "picture", progress);
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
                const RenderOptions& options, const std::string& stage, Progress& progress) {
  Image image{options.width, options.height, {}};
  image.rgba.assign(std::size_t(image.width) * image.height * 4, 0.0f);
  progress.begin(stage, items.tileCount());
  forSamples(
      mesh, items, field, [&](std::size_t) { return RgbPixel(image, options.background); },
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
  const std::vector<double> sky =
      rgbOf(background(materials.lights, materials.bands), materials.bands);
  if (!sky.empty()) light.sky = Vec3(sky[0], sky[1], sky[2]);
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

Image renderRadiance(const PatchMesh& mesh, const SurfaceLight& light, const Camera& camera,
                     const RenderOptions& options, Progress& progress) {
  RenderOptions with_sky = options;
  if (light.sky != Vec3(0.0)) with_sky.background = light.sky;
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
    return draw(mesh, field, camera, with_sky, progress);
  }
  return renderRadiance(mesh, light.patches, light.corners, camera, with_sky, progress);
}

}  // namespace radiosity
