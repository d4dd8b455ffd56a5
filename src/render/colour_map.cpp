#include "render/colour_map.h"

#include <algorithm>
#include <glm/common.hpp>

#include "base/srgb.h"

namespace radiosity {
namespace {

/// Every 16th of the 256 published colours, and the last: sRGB, 8 bits a channel. Linear
/// interpolation between them stays within 2/255 of the map.
constexpr std::array<std::uint32_t, 17> kViridis = {
    0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c,
    0x1fa088, 0x28ae80, 0x3fbc73, 0x5ec962, 0x84d44b, 0xaddc30, 0xd8e219, 0xfde725};

Vec3 coded(std::uint32_t hex) {
  return Vec3((hex >> 16) & 0xff, (hex >> 8) & 0xff, hex & 0xff) / 255.0;
}

Vec3 viridis(double t) {
  // The control points are at 0, 16/255, 32/255, ... 240/255, 1.
  const double position = t * 255 / 16;
  const auto k = std::min(std::size_t(position), kViridis.size() - 2);
  const double end = k + 2 == kViridis.size() ? 255.0 / 16 : double(k + 1);
  return glm::mix(coded(kViridis[k]), coded(kViridis[k + 1]),
                  (position - double(k)) / (end - double(k)));
}

}  // namespace

ColourMap::ColourMap() {
  for (int k = 0; k <= kSteps; ++k) {
    const Vec3 c = viridis(double(k) / kSteps);
    table_[k] = {linearFromSrgb(c.x), linearFromSrgb(c.y), linearFromSrgb(c.z)};
  }
}

Vec3 ColourMap::at(double t) const {
  const double position = std::clamp(t, 0.0, 1.0) * kSteps;
  const int k = std::min(int(position), kSteps - 1);
  return glm::mix(table_[k], table_[k + 1], position - k);
}

}  // namespace radiosity
