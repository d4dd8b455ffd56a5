#include "scene/assimp/assimp_materials.h"

#include <assimp/material.h>
#include <assimp/mesh.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/srgb.h"
#include "radiosity/spelling.h"
#include "scene/image_path.h"
#include "scene/text.h"
#include "scene/texture.h"

namespace radiosity {

namespace {

class AssimpMaterialReader {
 public:
  AssimpMaterialReader(const AssimpScene& file, const SceneOptions& options, Scene& scene,
                       FeatureNotes& ignored)
      : file_(file), options_(options), scene_(scene), ignored_(ignored) {}

  std::vector<AssimpMaterial> read() {
    std::vector<AssimpMaterial> all;
    for (unsigned m = 0; m < file_.materials.size(); ++m) {
      const std::string& name = file_.materials[m].name;
      const Index index = added(name, convert(file_.materials[m], m, name));
      all.push_back({index, has_colour_});
    }
    return all;
  }

 private:
  Material convert(const AssimpFileMaterial& given, unsigned number, std::string name);
  Index added(const std::string& name, Material material);
  Index texture(const AssimpFileMaterial& given, const std::string& material);
  LoadedTexture& loaded(const AssimpTexture& texture, bool repeat);
  TextureResult readImage(const AssimpTexture& texture);

  const AssimpScene& file_;
  const SceneOptions& options_;
  Scene& scene_;
  FeatureNotes& ignored_;
  UniqueNames names_;
  std::map<std::pair<std::string, bool>, LoadedTexture> texture_of_;  ///< by name, repeat
  std::map<std::string, std::vector<Index>> added_;                   ///< by the name in the file
  bool has_colour_ = false;                                           ///< the present material
};

Vec3 colourOr(const std::optional<std::array<float, 3>>& given, const Vec3& otherwise) {
  if (!given) return otherwise;
  const auto& [red, green, blue] = *given;
  return Vec3(double(red), double(green), double(blue));
}

Material AssimpMaterialReader::convert(const AssimpFileMaterial& given, unsigned number,
                                       std::string name) {
  has_colour_ = false;
  // Assimp adds a grey material for meshes without one.
  if (name == AI_DEFAULT_MATERIAL_NAME) return defaultMaterial(kNoMaterial, options_);
  if (name.empty()) name = fmt::format("material {}", number);
  Material material = defaultMaterial(name, options_);
  has_colour_ = given.diffuse.has_value();
  material.reflectance =
      settledReflectance(colourOr(given.diffuse, material.reflectance), name, ignored_);
  const Vec3 radiance = colourOr(given.emissive, Vec3(0.0));
  if (options_.kd_is_srgb && isReflectance(material.reflectance)) {
    for (int band = 0; band < 3; ++band) {
      material.reflectance[band] = linearFromSrgb(material.reflectance[band]);
    }
  }
  material.emission = std::numbers::pi * radiance;
  if (given.two_sided) material.two_sided = *given.two_sided != 0;
  if (given.opacity.value_or(1) < 1) {
    ignored_.add(solidFeature(), material.name, Severity::warning);
  }
  if (given.opacity_textures > 0) ignored_.add(maskFeature(), material.name, Severity::warning);
  for (const std::uint32_t bumps : {given.normal_textures, given.height_textures}) {
    if (bumps == 0) continue;
    ignored_.add("normal and bump maps are not used, material", material.name);
  }
  material.texture = texture(given, material.name);
  const bool lacks_texture =
      options_.textures && material.texture == kNone && given.diffuse_textures > 0;
  if (lacks_texture && (material.reflectance == Vec3(0.0) || material.reflectance == Vec3(1.0))) {
    replaceStandIn(material, material.name, "colour", options_, ignored_);
  }
  const bool glows = given.emissive_textures > 0;
  if (glows && options_.textures) {
    ignored_.add(fmt::format("emission textures of this format are not read; they EMIT NOTHING ({} "
                             "gives them one all over), material",
                             spelled("set", "NAME.radiance")),
                 material.name, Severity::loud);
    material.emission = Vec3(0.0);
  }
  return material;
}

/// Adds a material, or returns an equal one of the same name, or one without a name: some formats
/// give each object its own.
Index AssimpMaterialReader::added(const std::string& name, Material material) {
  std::vector<Index>& of_name = added_[name];
  for (const Index index : of_name) {
    const Material& other = scene_.materials[index];
    if (other.reflectance == material.reflectance && other.emission == material.emission &&
        other.texture == material.texture && other.two_sided == material.two_sided) {
      return index;
    }
  }
  material.name = names_.make(material.name);
  of_name.push_back(Index(scene_.materials.size()));
  scene_.materials.push_back(std::move(material));
  return of_name.back();
}

Index AssimpMaterialReader::texture(const AssimpFileMaterial& given, const std::string& material) {
  if (given.diffuse_textures == 0) return kNone;
  if (!options_.textures) {
    ignored_.add("textures are off; the colour alone counts, material", material);
    return kNone;
  }
  if (!given.texture) return kNone;
  const AssimpTexture& texture = *given.texture;
  const std::string& name = texture.path;
  const auto unusable = [&](const std::string& problem) {
    noteUnusedTexture(name, problem, TextureUse::reflectance, "colour", material, ignored_);
    return kNone;
  };
  if (texture.by_coordinates == 0) return unusable("is not mapped by coordinates");
  if (texture.set >= AI_MAX_NUMBER_OF_TEXTURECOORDS) return unusable("names no set of coordinates");
  const bool clamp = texture.wrap[0] == aiTextureMapMode_Clamp;
  if (texture.wrap[0] != texture.wrap[1] || (!clamp && texture.wrap[0] != aiTextureMapMode_Wrap)) {
    ignored_.add(fmt::format("texture wrapping that is mirrored or differs by axis is taken as {}, "
                             "material",
                             clamp ? "clamped" : "repeated"),
                 material, Severity::warning);
  }
  if (texture.blend != 1 || given.diffuse_textures > 1) {
    ignored_.add(
        "layers and blending of textures are not used, the first texture alone counts, material",
        material, Severity::warning);
  }
  const LoadedTexture& found = loaded(texture, !clamp);
  const std::string problem = found.problemAs(TextureUse::reflectance);
  return problem.empty() ? found.index : unusable(problem);
}

LoadedTexture& AssimpMaterialReader::loaded(const AssimpTexture& texture, bool repeat) {
  const std::string& name = texture.path;
  const auto [place, is_new] = texture_of_.try_emplace({name, repeat});
  if (is_new) {
    TextureResult result = readImage(texture);
    if (result.has_alpha) ignored_.add("alpha is not used, texture", name);
    place->second = keepTexture(std::move(result), repeat, scene_);
  }
  return place->second;
}

TextureResult AssimpMaterialReader::readImage(const AssimpTexture& texture) {
  if (!texture.embedded) {
    const std::string folder = std::filesystem::path(scene_.file).parent_path().string();
    return readTexture(findImage(folder, texture.path, ignored_), options_.max_image);
  }
  const AssimpImage& image = file_.images[*texture.embedded];
  if (image.is_bare != 0) {
    TextureResult result;
    result.problem = "is embedded as bare texels, which are not read";
    return result;
  }
  const auto* bytes = reinterpret_cast<const unsigned char*>(image.bytes.data());
  return decodeTexture(texture.path, {bytes, image.bytes.size()}, options_.max_image);
}

}  // namespace

std::vector<AssimpMaterial> readAssimpMaterials(const AssimpScene& file,
                                                const SceneOptions& options, Scene& scene,
                                                FeatureNotes& ignored) {
  return AssimpMaterialReader(file, options, scene, ignored).read();
}

}  // namespace radiosity
