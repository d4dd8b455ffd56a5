// Means of textures over areas.
#pragma once

#include <span>
#include <vector>

#include "radiosity/scene.h"

namespace radiosity {

/// Half as wide and as high (at least 1); texels are the means of those that they cover.
Texture halved(const Texture& texture);

/// A texture of texels with constant colour, with box-filtered half-size versions.
class TextureMean {
 public:
  explicit TextureMean(const Texture& texture);

  /// The mean over a convex polygon of texture coordinates: every texel is weighted by its area in
  /// the polygon. It is exact to rounding if the polygon's box has at most kMostTexels texels.
  /// Larger polygons are summed over the first halved texture with few enough texels; that widens
  /// the polygon's edge by less than 1/256 of its box.
  Vec3 over(std::span<const Vec2> uv) const;

  /// The texel at (u, v).
  Vec3 at(const Vec2& uv) const;

  /// The colour at (u, v), linear between the centres of texels (bilinear). `spacing`: of the
  /// points asked about, in texels; above 1 those of the halved texture that has about one texel a
  /// point (a mip map; Williams, "Pyramidal parametrics", 1983).
  Vec3 filtered(const Vec2& uv, double spacing) const;

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
  /// Adds row j of the polygon, in texels; texels from `from` to `to` are covered completely.
  void addRow(const Level& level, const std::vector<Vec2>& polygon, double j, double from,
              double to, Sum& sum) const;

  const Texture& texture_;
  std::vector<Level> levels_;
};

}  // namespace radiosity
