// What the scenes of all other renderers are made of.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "radiosity/interchange.h"

namespace radiosity {

/// The triangles of a surface, with vertices of their own.
struct SurfaceTriangles {
  Index surface = 0;
  std::vector<Vec3> vertices;   ///< metres
  std::vector<Vec2> texcoords;  ///< one a vertex, v downwards, or none
  std::vector<std::array<Index, 3>> triangles;
};

/// By surface, without those that have no area. Texture coordinates where the material has a
/// texture.
std::vector<SurfaceTriangles> surfaceTriangles(const Scene& scene);

/// The radiance of a material, W/m^2/sr: E / pi, times the mean of its texture of emission.
Vec3 meanRadiance(const Scene& scene, const Material& material);

/// The reflectance of a material that has a texture, texel by texel.
Image reflectanceImage(const Scene& scene, const Material& material);

/// The radiance of all that is seen where nothing stands, W/m^2/sr. `direction`, unit: of a pixel.
Image skyImage(std::span<const Light> lights, int width, int height,
               const std::function<Vec3(int column, int row)>& direction);

}  // namespace radiosity
