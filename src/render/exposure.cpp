// Maps linear values to the range of a display.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/luminance.h"
#include "radiosity/render.h"
#include "render/percentile.h"

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

double autoExposure(const Image& image) {
  std::vector<double> luminance;
  for (std::size_t k = 0; k + 3 < image.rgba.size(); k += 4) {
    const float* p = image.rgba.data() + k;
    if (p[3] > 0) luminance.push_back(luminanceOf(Vec3(p[0], p[1], p[2])));
  }
  if (luminance.empty()) return 0;
  const double bright = percentile(luminance, 0.99);
  if (!(bright > 0)) return 0;
  // A lamp that fills more than 1% of the picture would set the exposure alone and leave the room
  // black. So the median of the lit pixels stays at a tenth of the range or above.
  std::erase_if(luminance, [](double value) { return !(value > 0); });
  const double middle = percentile(luminance, 0.5);
  return std::log2(0.8 / std::min(bright, 8 * middle));
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
