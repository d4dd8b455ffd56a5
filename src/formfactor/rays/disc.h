// From the unit square to the unit disc, and so to cosine-distributed directions.
#pragma once

#include <cmath>

namespace radiosity {

/// cos and sin of angles up to pi / 4, to 1e-7.
inline float smallCos(float x) {
  const float y = x * x;
  return 1 + y * (-0.5F + y * (1.0F / 24 + y * (-1.0F / 720 + y * (1.0F / 40320))));
}
inline float smallSin(float x) {
  const float y = x * x;
  return x * (1 + y * (-1.0F / 6 + y * (1.0F / 120 + y * (-1.0F / 5040))));
}

/// A point of the unit disc (Shirley and Chiu 1997, concentric), which keeps neighbours together.
inline void toDisc(float x, float y, float& u, float& v) {
  const float a = 2 * x - 1;
  const float b = 2 * y - 1;
  const bool wide = std::abs(a) > std::abs(b);
  const float radius = wide ? a : b;
  const float other = wide ? b : a;
  const float angle = radius == 0 ? 0 : 0.785398163F * (other / radius);
  const float along = radius * smallCos(angle);
  const float across = radius * smallSin(angle);
  u = wide ? along : across;
  v = wide ? across : along;
}

}  // namespace radiosity
