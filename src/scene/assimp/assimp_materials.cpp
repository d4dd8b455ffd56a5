#include "scene/assimp/assimp_materials.h"

#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "base/srgb.h"
#include "scene/assimp/assimp_library.h"
#include "scene/image_path.h"
#include "scene/text.h"
#include "scene/texture.h"

namespace radiosity {

namespace {

class AssimpMaterialReader {
 public:
  AssimpMaterialReader(const aiScene& file, const std::map<unsigned, std::string>& names,
                       const SceneOptions& options, Scene& scene, FeatureNotes& ignored)
      : file_(file), known_names_(names), options_(options), scene_(scene), ignored_(ignored) {}

  std::vector<AssimpMaterial> read() {
    std::vector<AssimpMaterial> all;
    for (unsigned m = 0; m < file_.mNumMaterials; ++m) {
      if (!known_names_.empty() && !known_names_.contains(m)) {
        all.push_back({kNone, 0, false});
        continue;
      }
      const std::string name = nameOf(*file_.mMaterials[m], m);
      const Index index = added(name, convert(*file_.mMaterials[m], m, name));
      all.push_back({index, set_, has_colour_});
    }
    return all;
  }

 private:
  std::string nameOf(const aiMaterial& given, unsigned number) const;
  Material convert(const aiMaterial& given, unsigned number, std::string name);
  Index added(const std::string& name, Material material);
  std::optional<Vec3> colour(const aiMaterial& given, const char* key) const;
  Index texture(const aiMaterial& given, const std::string& material);
  LoadedTexture& loaded(const std::string& name, bool repeat);
  TextureResult readImage(const std::string& name);

  const aiScene& file_;
  const std::map<unsigned, std::string>& known_names_;  ///< by number
  const SceneOptions& options_;
  Scene& scene_;
  FeatureNotes& ignored_;
  const AssimpLibrary& library_ = assimpLibrary();
  UniqueNames names_;
  std::map<std::pair<std::string, bool>, LoadedTexture> texture_of_;  ///< by name, repeat
  std::map<std::string, std::vector<Index>> added_;                   ///< by the name in the file
  unsigned set_ = 0;         ///< of texture coordinates, of the present material
  bool has_colour_ = false;  ///< the present material
};

// We write out keys of materials, since AI_MATKEY macros expand to three arguments at once.

std::optional<Vec3> AssimpMaterialReader::colour(const aiMaterial& given, const char* key) const {
  aiColor4D found;
  if (library_.getMaterialColor(&given, key, 0, 0, &found) != AI_SUCCESS) return std::nullopt;
  return Vec3(double(found.r), double(found.g), double(found.b));
}

/// The name in the file, or nothing.
std::string AssimpMaterialReader::nameOf(const aiMaterial& given, unsigned number) const {
  const auto known = known_names_.find(number);
  if (known != known_names_.end()) return known->second;
  aiString text;
  const bool is_named = library_.getMaterialString(&given, AI_MATKEY_NAME, &text) == AI_SUCCESS;
  return is_named ? text.C_Str() : "";
}

Material AssimpMaterialReader::convert(const aiMaterial& given, unsigned number, std::string name) {
  set_ = 0;
  has_colour_ = false;
  // Assimp adds a grey material for meshes without one.
  if (name == AI_DEFAULT_MATERIAL_NAME) return defaultMaterial(kNoMaterial, options_);
  if (name.empty()) name = fmt::format("material {}", number);
  Material material = defaultMaterial(name, options_);
  const std::optional<Vec3> diffuse = colour(given, "$clr.diffuse");
  has_colour_ = diffuse.has_value();
  material.reflectance = settledReflectance(diffuse.value_or(material.reflectance), name, ignored_);
  const Vec3 radiance = colour(given, "$clr.emissive").value_or(Vec3(0.0));
  if (options_.kd_is_srgb && isReflectance(material.reflectance)) {
    for (int band = 0; band < 3; ++band) {
      material.reflectance[band] = linearFromSrgb(material.reflectance[band]);
    }
  }
  material.emission = std::numbers::pi * radiance;
  int two_sided = 0;
  if (library_.getMaterialIntegerArray(&given, AI_MATKEY_TWOSIDED, &two_sided, nullptr) ==
      AI_SUCCESS) {
    material.two_sided = two_sided != 0;
  }
  float opacity = 1;
  if (library_.getMaterialFloatArray(&given, AI_MATKEY_OPACITY, &opacity, nullptr) == AI_SUCCESS &&
      opacity < 1) {
    ignored_.add(kSolidFeature, material.name, Severity::warning);
  }
  if (library_.getMaterialTextureCount(&given, aiTextureType_OPACITY) > 0) {
    ignored_.add(kMaskFeature, material.name, Severity::warning);
  }
  for (const aiTextureType bumps : {aiTextureType_NORMALS, aiTextureType_HEIGHT}) {
    if (library_.getMaterialTextureCount(&given, bumps) == 0) continue;
    ignored_.add("normal and bump maps are not used, material", material.name);
  }
  material.texture = texture(given, material.name);
  const bool lacks_texture = options_.textures && material.texture == kNone &&
                             library_.getMaterialTextureCount(&given, aiTextureType_DIFFUSE) > 0;
  if (lacks_texture && (material.reflectance == Vec3(0.0) || material.reflectance == Vec3(1.0))) {
    replaceStandIn(material, material.name, "colour", options_, ignored_);
  }
  const bool glows = library_.getMaterialTextureCount(&given, aiTextureType_EMISSIVE) > 0;
  if (glows && options_.textures) {
    ignored_.add(
        "emission textures of this format are not read; they EMIT NOTHING (--set NAME.radiance "
        "gives them one all over), material",
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

Index AssimpMaterialReader::texture(const aiMaterial& given, const std::string& material) {
  if (library_.getMaterialTextureCount(&given, aiTextureType_DIFFUSE) == 0) return kNone;
  if (!options_.textures) {
    ignored_.add("textures are off; the colour alone counts, material", material);
    return kNone;
  }
  aiString path;
  aiTextureMapping mapping = aiTextureMapping_UV;
  ai_real blend = 1;
  aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
  if (library_.getMaterialTexture(&given, aiTextureType_DIFFUSE, 0, &path, &mapping, &set_, &blend,
                                  nullptr, modes, nullptr) != AI_SUCCESS) {
    return kNone;
  }
  const std::string name = path.C_Str();
  const auto unusable = [&](const std::string& problem) {
    noteUnusedTexture(name, problem, TextureUse::reflectance, "colour", material, ignored_);
    return kNone;
  };
  if (mapping != aiTextureMapping_UV) return unusable("is not mapped by coordinates");
  if (set_ >= AI_MAX_NUMBER_OF_TEXTURECOORDS) return unusable("names no set of coordinates");
  const bool clamp = modes[0] == aiTextureMapMode_Clamp;
  if (modes[0] != modes[1] || (!clamp && modes[0] != aiTextureMapMode_Wrap)) {
    ignored_.add(fmt::format("texture wrapping that is mirrored or differs by axis is taken as {}, "
                             "material",
                             clamp ? "clamped" : "repeated"),
                 material, Severity::warning);
  }
  if (blend != ai_real(1) || library_.getMaterialTextureCount(&given, aiTextureType_DIFFUSE) > 1) {
    ignored_.add(
        "layers and blending of textures are not used, the first texture alone counts, material",
        material, Severity::warning);
  }
  const LoadedTexture& found = loaded(name, !clamp);
  const std::string problem = found.problemAs(TextureUse::reflectance);
  return problem.empty() ? found.index : unusable(problem);
}

LoadedTexture& AssimpMaterialReader::loaded(const std::string& name, bool repeat) {
  const auto [place, is_new] = texture_of_.try_emplace({name, repeat});
  if (is_new) {
    TextureResult result = readImage(name);
    if (result.has_alpha) ignored_.add("alpha is not used, texture", name);
    place->second = keepTexture(std::move(result), repeat, scene_);
  }
  return place->second;
}

TextureResult AssimpMaterialReader::readImage(const std::string& name) {
  const aiTexture* embedded = file_.GetEmbeddedTexture(name.c_str());
  if (embedded == nullptr) {
    const std::string folder = std::filesystem::path(scene_.file).parent_path().string();
    return readTexture(findImage(folder, name, ignored_), options_.max_image);
  }
  if (embedded->mHeight != 0) {
    TextureResult result;
    result.problem = "is embedded as bare texels, which are not read";
    return result;
  }
  // Compressed, of mWidth bytes.
  const auto* bytes = reinterpret_cast<const unsigned char*>(embedded->pcData);
  return decodeTexture(name, {bytes, embedded->mWidth}, options_.max_image);
}

}  // namespace

std::vector<AssimpMaterial> readAssimpMaterials(const aiScene& file,
                                                const std::map<unsigned, std::string>& names,
                                                const SceneOptions& options, Scene& scene,
                                                FeatureNotes& ignored) {
  return AssimpMaterialReader(file, names, options, scene, ignored).read();
}

}  // namespace radiosity
