// Maps linear values to the range of a display.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/luminance.h"
#include "radiosity/render.h"
#include "render/percentile.h"
#include "render/seen_points.h"

namespace radiosity {

namespace {

/// The 99th percentile of luminance over all pixels.
double brightest(const Image& image) {
  std::vector<double> values;
  for (std::size_t k = 0; k < image.rgba.size(); k += 4) {
    const float* p = image.rgba.data() + k;
    values.push_back(p[3] > 0 ? luminanceOf(Vec3(p[0], p[1], p[2])) : 0.0);
  }
  const auto high = values.begin() + std::ptrdiff_t(0.99 * double(values.size() - 1));
  std::nth_element(values.begin(), high, values.end());
  return *high;
}

}  // namespace

namespace {

/// The luminance of hit pixels that show no lamp.
std::vector<double> metered(const Image& image, std::span<const std::uint8_t> lamps) {
  std::vector<double> luminance;
  for (std::size_t k = 0; k + 3 < image.rgba.size(); k += 4) {
    const float* p = image.rgba.data() + k;
    const bool lamp = !lamps.empty() && lamps[k / 4] != 0;
    if (p[3] > 0 && !lamp) luminance.push_back(luminanceOf(Vec3(p[0], p[1], p[2])));
  }
  return luminance;
}

/// The exposure for these pixels, which are reordered; none if they are dark.
std::optional<double> exposureFor(std::vector<double>& luminance) {
  if (luminance.empty()) return std::nullopt;
  const double bright = percentile(luminance, 0.99);
  if (!(bright > 0)) return std::nullopt;
  // A window that fills more than 1% of the picture would set the exposure alone and leave the
  // room black. So the median of the lit pixels stays at a tenth of the range or above.
  std::erase_if(luminance, [](double value) { return !(value > 0); });
  const double middle = percentile(luminance, 0.5);
  return std::log2(0.8 / std::min(bright, 8 * middle));
}

}  // namespace

double autoExposure(const Image& image, std::span<const std::uint8_t> lamps) {
  std::vector<double> lit = metered(image, lamps);
  if (const std::optional<double> ev = exposureFor(lit)) return *ev;
  std::vector<double> all = metered(image, {});
  return exposureFor(all).value_or(0);
}

std::vector<std::uint8_t> lampPixels(const PatchMesh& mesh, const SurfaceLight& light,
                                     const Camera& camera, const RenderOptions& options) {
  options.validate();
  std::vector<std::uint8_t> lamp(mesh.size());
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    const double* b = light.patches.data() + 3 * i;
    lamp[i] = luminanceOf(Vec3(b[0], b[1], b[2])) > 2 * light.reflected[i];
  }
  std::vector<std::uint8_t> pixels;
  for (const SeenPoint& seen : middlesOfPixels(mesh, camera, options)) {
    pixels.push_back(seen.patch == kNone || seen.back ? 0 : lamp[seen.patch]);
  }
  return pixels;
}

std::optional<UnlitView> unlitView(const PatchMesh& mesh, const SurfaceLight& light,
                                   const Image& radiance) {
  constexpr double kDark = 1e-3;  // ten stops: black in a picture exposed for the lit part
  const double lit = typicalLight(mesh, light.reflected) / std::numbers::pi;
  const double seen = brightest(radiance);
  if (!(lit > 0) || seen >= kDark * lit) return std::nullopt;
  const auto most = std::max_element(light.reflected.begin(), light.reflected.end());
  return UnlitView{seen, lit, Index(most - light.reflected.begin())};
}

Image exposed(const Image& image, double ev) {
  Image result = image;
  const double factor = std::exp2(ev);
  for (std::size_t k = 0; k < result.rgba.size(); ++k) {
    if (k % 4 != 3) result.rgba[k] = float(result.rgba[k] * factor);
  }
  return result;
}

}  // namespace radiosity
