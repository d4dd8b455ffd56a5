// From linear values to a display's range.
#include <algorithm>
#include <cmath>

#include "radiosity/render.h"

namespace radiosity {

double autoExposure(const Image& image) {
  std::vector<double> luminance;
  for (std::size_t k = 0; k + 3 < image.rgba.size(); k += 4) {
    const float* p = image.rgba.data() + k;
    // Rec. ITU-R BT.709: relative luminance of linear RGB.
    if (p[3] > 0) luminance.push_back(0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2]);
  }
  if (luminance.empty()) return 0;
  // Nearest rank: the smallest value that at least 99% of the pixels do not exceed.
  const auto rank = std::size_t(std::ceil(0.99 * double(luminance.size()))) - 1;
  std::nth_element(luminance.begin(), luminance.begin() + std::ptrdiff_t(rank), luminance.end());
  return luminance[rank] > 0 ? std::log2(0.8 / luminance[rank]) : 0;
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
