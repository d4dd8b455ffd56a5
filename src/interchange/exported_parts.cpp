#include "interchange/exported_parts.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "lightmap/face_triangles.h"

namespace radiosity {

std::vector<SurfaceTriangles> surfaceTriangles(const Scene& scene) {
  std::vector<SurfaceTriangles> all(scene.surfaces.size());
  std::vector<std::map<std::tuple<Index, double, double>, Index>> known(all.size());
  for (const FaceTriangle& t : frontTriangles(scene)) {
    SurfaceTriangles& surface = all[t.surface];
    surface.surface = t.surface;
    const bool textured = scene.materialOf(t.face).texture != kNone && !scene.texcoords.empty();
    std::array<Index, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t corner = scene.face_offset[t.face] + t.corner[k];
      const Vec2 place = textured ? scene.texcoords[corner] : Vec2(0);
      const auto [at, is_new] = known[t.surface].try_emplace(
          {scene.corners[corner], place.x, place.y}, Index(surface.vertices.size()));
      if (is_new) {
        surface.vertices.push_back(t.position[k]);
        if (textured) surface.texcoords.push_back(place);
      }
      triangle[k] = at->second;
    }
    surface.triangles.push_back(triangle);
  }
  std::erase_if(all, [](const SurfaceTriangles& surface) { return surface.triangles.empty(); });
  return all;
}

Vec3 meanRadiance(const Scene& scene, const Material& material) {
  if (material.emission_texture == kNone) return material.radiance();
  const Texture& texture = scene.textures[material.emission_texture];
  Vec3 sum(0.0);
  for (std::size_t k = 0; k < texture.texels.size(); ++k) sum[int(k % 3)] += texture.texels[k];
  return material.radiance() * sum * (3.0 / double(texture.texels.size()));
}

Image reflectanceImage(const Scene& scene, const Material& material) {
  const Texture& texture = scene.textures[material.texture];
  Image image{texture.width, texture.height, {}};
  image.rgba.reserve(texture.texels.size() / 3 * 4);
  for (std::size_t k = 0; k < texture.texels.size(); k += 3) {
    for (int c = 0; c < 3; ++c) {
      image.rgba.push_back(float(material.reflectance[c] * texture.texels[k + std::size_t(c)]));
    }
    image.rgba.push_back(1);
  }
  return image;
}

Image skyImage(std::span<const Light> lights, int width, int height,
               const std::function<Vec3(int column, int row)>& direction) {
  const Background sky(lights, 3, true);
  Image image{width, height, {}};
  image.rgba.reserve(std::size_t(width) * std::size_t(height) * 4);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      std::array<double, 3> radiance{};
      sky.add(direction(column, row), 1, radiance);
      for (const double value : radiance) image.rgba.push_back(float(value));
      image.rgba.push_back(1);
    }
  }
  return image;
}

}  // namespace radiosity
