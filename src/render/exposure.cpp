// From linear values to a display's range.
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/luminance.h"
#include "radiosity/render.h"
#include "render/percentile.h"

namespace radiosity {
double autoExposure(const Image& image) {
  std::vector<double> luminance;
  for (std::size_t k = 0; k + 3 < image.rgba.size(); k += 4) {
    const float* p = image.rgba.data() + k;
    if (p[3] > 0) luminance.push_back(luminanceOf(Vec3(p[0], p[1], p[2])));
  }
  if (luminance.empty()) return 0;
  const double bright = percentile(luminance, 0.99);
  if (!(bright > 0)) return 0;
  // A lamp that fills more than 1% of the picture would set the exposure for itself and leave the
  // room black: the middle of what is lit stays at a tenth of the range or above.
  std::erase_if(luminance, [](double value) { return !(value > 0); });
  const double middle = percentile(luminance, 0.5);
  return std::log2(0.8 / std::min(bright, 8 * middle));
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
