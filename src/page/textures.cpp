#include "page/textures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/srgb.h"
#include "mesh/patches/texture_mean.h"

namespace radiosity::page {

namespace {

using Json = Container::Json;

/// The scene's textures that surfaces use, in the order in which they are met.
class UsedTextures {
 public:
  explicit UsedTextures(const Scene& scene)
      : scene_(scene), number_(scene.textures.size(), kNone) {}

  /// The number of a texture in the page; null if there is none.
  Json numberOf(Index texture) {
    if (texture == kNone || scene_.texcoords.empty()) return nullptr;
    if (number_[texture] == kNone) {
      number_[texture] = Index(textures_.size());
      textures_.push_back(scene_.textures[texture]);
    }
    return number_[texture];
  }

  std::size_t texels() const {
    std::size_t sum = 0;
    for (const Texture& texture : textures_) sum += texture.texels.size() / 3;
    return sum;
  }

  /// Halves the largest until all fit. Returns the number of those that were halved.
  std::size_t shrink() {
    std::vector<bool> is_smaller(textures_.size(), false);
    while (texels() > kMostTexels) {
      const auto largest = std::ranges::max_element(
          textures_, {}, [](const Texture& texture) { return texture.texels.size(); });
      *largest = halved(*largest);
      is_smaller[std::size_t(largest - textures_.begin())] = true;
    }
    return std::size_t(std::ranges::count(is_smaller, true));
  }

  const std::vector<Texture>& textures() const { return textures_; }

 private:
  const Scene& scene_;
  std::vector<Index> number_;  // by the scene's
  std::vector<Texture> textures_;
};

/// sRGB in 8 bits of texels over `scale`, each less the one to its left, modulo 256: most
/// differences are small, and pack better.
std::vector<std::uint8_t> codedTexels(const Texture& texture, double scale) {
  const auto row = std::size_t(texture.width) * 3;
  std::vector<std::uint8_t> coded(texture.texels.size());
  for (std::size_t k = coded.size(); k-- > 0;) {
    const auto code = [&](std::size_t at) {
      return std::lround(255 * srgbFromLinear(double(texture.texels[at]) / scale));
    };
    coded[k] = std::uint8_t(code(k) - (k % row < 3 ? 0 : code(k - 3)));
  }
  return coded;
}

}  // namespace

void addTextures(const Scene& scene, const PatchMesh& mesh, Container& container,
                 PageReport& report) {
  UsedTextures used(scene);
  Json& materials = container.header()["materials"];
  std::vector<bool> is_used(scene.materials.size(), false);
  for (const Index surface : mesh.surface) is_used[scene.surfaces[surface].material] = true;
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const Material& material = scene.materials[m];
    materials[m]["texture"] = is_used[m] ? used.numberOf(material.texture) : nullptr;
    materials[m]["emission_texture"] =
        is_used[m] ? used.numberOf(material.emission_texture) : nullptr;
  }
  report.halved_textures = used.shrink();
  report.textures = used.textures().size();
  report.texels = used.texels();
  Json described = Json::array();
  for (const Texture& texture : used.textures()) {
    const double scale = std::max(1.0, double(std::ranges::max(texture.texels)));
    container.add("texture_" + std::to_string(described.size()), codedTexels(texture, scale));
    described.push_back({{"name", texture.name},
                         {"width", texture.width},
                         {"height", texture.height},
                         {"repeat", texture.repeat},
                         {"scale", scale}});
  }
  container.header()["textures"] = described;
}

}  // namespace radiosity::page
