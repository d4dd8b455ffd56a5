// Textures for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "radiosity/scene.h"

namespace radiosity::test {

/// `width` x `height` texels with values that follow no pattern, 0 to 1.
inline Texture noise(int width, int height) {
  Texture texture;
  texture.width = width;
  texture.height = height;
  std::uint32_t state = 12345;
  for (int k = 0; k < 3 * width * height; ++k) {
    state = state * 1664525u + 1013904223u;
    texture.texels.push_back(float(state >> 8) / float(1 << 24));
  }
  return texture;
}

inline Vec3 texelOf(const Texture& texture, int i, int j) {
  const float* p = texture.texels.data() + 3 * (texture.width * j + i);
  return {double(p[0]), double(p[1]), double(p[2])};
}

inline Vec3 meanOf(const Texture& texture) {
  Vec3 sum(0.0);
  for (std::size_t k = 0; k < texture.texels.size(); ++k) sum[int(k % 3)] += texture.texels[k];
  return sum / (double(texture.texels.size()) / 3);
}

inline void expectNear(const Vec3& a, const Vec3& b, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "band " << c;
}

}  // namespace radiosity::test
