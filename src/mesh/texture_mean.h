// Means of textures over areas.
#pragma once

#include <span>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// A texture taken as texels of constant colour, with box-filtered halves of it.
class TextureMean {
 public:
  explicit TextureMean(const Texture& texture);

  /// The mean over a convex polygon of texture coordinates: every texel weighted by its area in
  /// the polygon, exact to rounding as long as the polygon's box has at most kMostTexels texels.
  /// Larger ones are summed over the first halved texture that has few enough; that widens the
  /// polygon's edge by less than 1/256 of its box.
  Vec3 over(std::span<const Vec2> uv) const;

  /// The texel at (u, v).
  Vec3 at(const Vec2& uv) const;

 private:
  static constexpr double kMostTexels = 256.0 * 256.0;
  struct Level {
    long width;
    long height;
    std::vector<float> halved;  ///< empty for the texture itself
  };
  struct Sum {
    Vec3 colour{0.0};
    double area = 0;
  };
  const float* pixel(const Level& level, long i, long j) const;
  Vec3 texel(const Level& level, long i, long j) const;
  Vec3 texelsBetween(const Level& level, long i, long end, long j) const;
  /// Row j of the polygon, in texels, which covers those from `from` to `to` whole.
  void addRow(const Level& level, const std::vector<Vec2>& polygon, double j, double from,
              double to, Sum& sum) const;

  const Texture& texture_;
  std::vector<Level> levels_;
};

}  // namespace radiosity
