#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "base/geometry/clip.h"
#include "base/parallel.h"
#include "mesh/patches/faces_under_patches.h"
#include "mesh/patches/texture_mean.h"
#include "radiosity/patch_mesh.h"

namespace radiosity {

namespace {

class PatchTexture {
 public:
  PatchTexture(const Scene& scene, const PatchMesh& mesh, std::span<const TextureMean> textures,
               const FacesUnderPatches& faces)
      : scene_(scene), mesh_(mesh), textures_(textures), faces_(faces) {}

  /// The area mean over patch i of what multiplies its reflectance: a texture of the scene (or
  /// kNone), and the vertex colours if `coloured`. Where both vary within one face and patch, the
  /// product of their means stands for the mean of their product.
  Vec3 mean(std::size_t i, Index texture_index, bool coloured) const {
    const TextureMean* texture = texture_index == kNone ? nullptr : &textures_[texture_index];
    Vec3 sum(0.0);
    const double area = faces_.forParts(
        i, coloured,
        [&](const FlatTriangle& triangle, const std::vector<Vec2>& part, double part_area) {
          const Vec3 texel = texture == nullptr ? Vec3(1.0) : meanOver(*texture, triangle, part);
          sum += part_area * texel * triangle.colourAt(polygonCentroid(part));
        });
    if (area > 0) return sum / area;
    // No face lies under the patch (the face is almost perpendicular): we take one corner's value.
    const std::size_t corner = scene_.face_offset[mesh_.source_face[i]];
    return (texture == nullptr ? Vec3(1.0) : texture->at(scene_.texcoords[corner])) *
           (coloured ? scene_.colours[corner] : Vec3(1.0));
  }

 private:
  static Vec3 meanOver(const TextureMean& texture, const FlatTriangle& triangle,
                       const std::vector<Vec2>& part) {
    std::vector<Vec2> uv;
    Vec2 low(std::numeric_limits<double>::infinity());
    Vec2 high = -low;
    for (const Vec2& p : part) {
      uv.push_back(triangle.map(p));
      low = glm::min(low, uv.back());
      high = glm::max(high, uv.back());
    }
    const Vec2 extent = high - low;
    if (std::abs(polygonArea(uv)) > 1e-6 * glm::dot(extent, extent)) return texture.over(uv);
    // The map is a line or a point (palettes, gradients): we take the texels at the middles of
    // equal parts of the polygon's fan.
    constexpr int kParts = 32;
    Vec3 colour(0.0);
    double total = 0;
    for (std::size_t k = 2; k < part.size(); ++k) {
      const Vec2 a = (part[k - 1] - part[0]) / double(kParts);
      const Vec2 b = (part[k] - part[0]) / double(kParts);
      for (int r = 0; r < kParts; ++r) {
        for (int s = 0; r + s < kParts; ++s) {
          const Vec2 corner = part[0] + double(r) * a + double(s) * b;
          const double area = std::max(0.0, cross2(a, b));  // below 0 by rounding only
          colour += area * texture.at(triangle.map(corner + (a + b) / 3.0));
          total += area;
          if (r + s + 1 == kParts) continue;
          colour += area * texture.at(triangle.map(corner + (a + b) * (2.0 / 3.0)));
          total += area;
        }
      }
    }
    return total > 0 ? colour / total : texture.at(uv[0]);
  }

  const Scene& scene_;
  const PatchMesh& mesh_;
  std::span<const TextureMean> textures_;
  const FacesUnderPatches& faces_;
};

}  // namespace

void PatchMaterials::requireSizes(std::size_t patches) const {
  if (bands < 1) {
    throw InputError(fmt::format("materials: {} bands; 1 or more are needed", bands));
  }
  const std::size_t needed = patches * std::size_t(bands);
  const auto check = [&](const char* what, std::size_t size) {
    if (size == needed) return;
    throw InputError(
        fmt::format("materials: {} {} are given, {} patches of {} bands take {}: a row of all "
                    "bands for each patch; set `bands` to what a row holds",
                    size, what, patches, bands, needed));
  };
  check("reflectances", reflectance.size());
  check("emissions", emission.size());
  for (const Light& light : lights) {
    if (light.strength.size() == std::size_t(bands)) continue;
    throw InputError(
        fmt::format("materials: the {} has {} bands, the patches have {}; give it as "
                    "many, or leave it out where it is dark",
                    light.name, light.strength.size(), bands));
  }
}

PatchMaterials patchMaterials(const Scene& scene, const PatchMesh& mesh) {
  PatchMaterials result;
  result.reflectance.resize(3 * mesh.size());
  result.emission.resize(3 * mesh.size());
  result.lights = scene.lights;
  const auto put = [](std::vector<double>& values, std::size_t i, const Vec3& value) {
    for (int b = 0; b < 3; ++b) values[3 * i + std::size_t(b)] = value[b];
  };
  std::vector<TextureMean> textures;
  textures.reserve(scene.textures.size());
  for (const Texture& texture : scene.textures) textures.emplace_back(texture);
  const VaryingSurfaces varying(scene);
  const FacesUnderPatches faces(scene, mesh, varying);
  const PatchTexture patch_texture(scene, mesh, textures, faces);
  parallelFor(mesh.size(), 64, [&](std::size_t i) {
    const Material& material = scene.materials[scene.surfaces[mesh.surface[i]].material];
    Vec3 reflectance = material.reflectance;
    Vec3 emission = material.emission;
    const Index surface = mesh.surface[i];
    if (faces.varies(i)) {
      const auto used = [&](Index texture) { return varying.textured[surface] ? texture : kNone; };
      const Index texture = used(material.texture);
      if (texture != kNone || varying.coloured[surface]) {
        reflectance *= patch_texture.mean(i, texture, varying.coloured[surface]);
      }
      if (used(material.emission_texture) != kNone) {
        emission *= patch_texture.mean(i, material.emission_texture, false);
      }
    }
    put(result.reflectance, i, reflectance);
    put(result.emission, i, emission);
  });
  for (std::size_t i = 0; i < mesh.size(); ++i) {
    if (mesh.side[i] == 0) continue;
    for (std::size_t b = 0; b < 3; ++b) {
      result.reflectance[3 * i + b] = result.reflectance[3 * mesh.twin[i] + b];
      result.emission[3 * i + b] = result.emission[3 * mesh.twin[i] + b];
    }
  }
  return result;
}

std::vector<Index> emittingPatches(const PatchMesh& mesh, const PatchMaterials& materials) {
  materials.requireSizes(mesh.size());
  const auto bands = std::size_t(materials.bands);
  std::vector<Index> patches;
  for (Index i = 0; i < mesh.size(); ++i) {
    const auto emission = std::span(materials.emission).subspan(i * bands, bands);
    if (std::any_of(emission.begin(), emission.end(), [](double m) { return m > 0; })) {
      patches.push_back(i);
    }
  }
  return patches;
}

}  // namespace radiosity
