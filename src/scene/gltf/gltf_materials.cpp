#include "scene/gltf/gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "radiosity/spelling.h"
#include "scene/texture.h"

namespace radiosity {

namespace {

constexpr const char* kTextureTransform = "KHR_texture_transform";
constexpr const char* kSpecularGlossiness = "KHR_materials_pbrSpecularGlossiness";

Vec2 pairOf(const tinygltf::Value& value, const Vec2& otherwise) {
  if (!value.IsArray() || value.ArrayLen() != 2) return otherwise;
  return {value.Get(0).GetNumberAsDouble(), value.Get(1).GetNumberAsDouble()};
}

/// The image of a texture: a WebP (EXT_texture_webp) if there is no PNG or JPEG. -1: neither, for
/// instance if KHR_texture_basisu has the only one.
int imageOf(const tinygltf::Texture& texture) {
  const auto webp = texture.extensions.find("EXT_texture_webp");
  if (texture.source >= 0 || webp == texture.extensions.end()) return texture.source;
  return webp->second.Has("source") ? webp->second.Get("source").GetNumberAsInt() : -1;
}

class GltfMaterialReader {
 public:
  GltfMaterialReader(const GltfFile& file, const SceneOptions& options, Scene& scene,
                     FeatureNotes& ignored)
      : file_(file), options_(options), scene_(scene), ignored_(ignored) {}

  GltfMaterials read();

 private:
  struct Diffuse {
    Vec3 factor;
    tinygltf::TextureInfo texture;
  };
  Diffuse diffuseOf(const tinygltf::Material& gltf, const std::string& name) const;
  Material convert(const tinygltf::Material& gltf, const std::string& name);
  Vec3 emission(const tinygltf::Material& gltf, const std::string& name) const;
  Index texture(const tinygltf::TextureInfo& info, TextureUse use, const std::string& material);
  bool repeats(const tinygltf::Texture& texture, const std::string& material);
  static TexcoordSource texcoords(const tinygltf::TextureInfo& info);
  Index emissionTexture(const tinygltf::Material& gltf, Material& material);
  void noteIgnored(const tinygltf::Material& gltf, const std::string& name);

  const GltfFile& file_;
  const SceneOptions& options_;
  Scene& scene_;
  FeatureNotes& ignored_;
  std::map<std::pair<int, bool>, LoadedTexture> texture_of_;  ///< by image, repeat
};

GltfMaterials GltfMaterialReader::read() {
  GltfMaterials result;
  UniqueNames names;
  for (std::size_t m = 0; m < file_.model.materials.size(); ++m) {
    const tinygltf::Material& gltf = file_.model.materials[m];
    const std::string name =
        names.make(gltf.name.empty() ? fmt::format("material{}", m) : gltf.name);
    scene_.materials.push_back(convert(gltf, name));
    result.unlit.push_back(gltf.extensions.contains("KHR_materials_unlit"));
    const bool glows_alone = scene_.materials.back().texture == kNone;
    result.texcoords.push_back(
        texcoords(glows_alone ? gltf.emissiveTexture : diffuseOf(gltf, name).texture));
    noteIgnored(gltf, name);
  }
  return result;
}

Material GltfMaterialReader::convert(const tinygltf::Material& gltf, const std::string& name) {
  Material material;
  material.name = name;
  material.two_sided = gltf.doubleSided;
  const Diffuse diffuse = diffuseOf(gltf, name);
  material.reflectance = settledReflectance(diffuse.factor, name, ignored_);
  material.emission = emission(gltf, name);
  if (diffuse.texture.index >= 0) {
    if (options_.textures) {
      material.texture = texture(diffuse.texture, TextureUse::reflectance, name);
      if (material.texture == kNone && material.reflectance == Vec3(1.0)) {
        replaceStandIn(material, name, "base colour", options_, ignored_);
      }
    } else {
      ignored_.add("textures are off; the factor alone counts, material", name);
    }
  }
  material.emission_texture = emissionTexture(gltf, material);
  return material;
}

/// The base colour, or the diffuse colour of KHR_materials_pbrSpecularGlossiness.
GltfMaterialReader::Diffuse GltfMaterialReader::diffuseOf(const tinygltf::Material& gltf,
                                                          const std::string& name) const {
  const tinygltf::PbrMetallicRoughness& pbr = gltf.pbrMetallicRoughness;
  Diffuse diffuse{Vec3(1.0), pbr.baseColorTexture};
  const auto extension = gltf.extensions.find(kSpecularGlossiness);
  if (extension == gltf.extensions.end()) {
    if (pbr.baseColorFactor.size() < 3) {
      file_.fail(fmt::format("material {}: baseColorFactor is not 4 numbers; correct it", name));
    }
    for (int b = 0; b < 3; ++b) diffuse.factor[b] = pbr.baseColorFactor[std::size_t(b)];
    return diffuse;
  }
  const tinygltf::Value& factor = memberOf(extension->second, "diffuseFactor");
  if (factor.IsArray()) {
    if (factor.ArrayLen() < 3) {
      file_.fail(fmt::format("material {}: diffuseFactor is not 4 numbers; correct it", name));
    }
    for (int b = 0; b < 3; ++b) diffuse.factor[b] = factor.Get(b).GetNumberAsDouble();
  }
  diffuse.texture = {};
  const tinygltf::Value& texture = memberOf(extension->second, "diffuseTexture");
  if (!texture.IsObject()) return diffuse;
  diffuse.texture.index = texture.Get("index").GetNumberAsInt();
  if (texture.Has("texCoord")) diffuse.texture.texCoord = texture.Get("texCoord").GetNumberAsInt();
  const tinygltf::Value& transform = memberOf(texture.Get("extensions"), kTextureTransform);
  if (transform.IsObject()) diffuse.texture.extensions[kTextureTransform] = transform;
  return diffuse;
}

/// The emission texture, if it can be used: a corner of a face has only one pair of texture
/// coordinates. Otherwise the material emits nothing.
Index GltfMaterialReader::emissionTexture(const tinygltf::Material& gltf, Material& material) {
  if (gltf.emissiveTexture.index < 0 || material.emission == Vec3(0.0)) return kNone;
  if (!options_.textures) {
    ignored_.add("textures are off; the factor alone counts, material", material.name);
    return kNone;
  }
  const bool alone = material.texture == kNone;
  if (!alone &&
      !(texcoords(gltf.emissiveTexture) == texcoords(diffuseOf(gltf, material.name).texture))) {
    ignored_.add(fmt::format("the emission texture has other coordinates than the base colour and "
                             "is not used; it EMITS NOTHING ({} gives it one all over), material",
                             spelled("set", "NAME.radiance")),
                 material.name, Severity::loud);
    material.emission = Vec3(0.0);
    return kNone;
  }
  const Index found = texture(gltf.emissiveTexture, TextureUse::emission, material.name);
  if (found == kNone) material.emission = Vec3(0.0);
  return found;
}

/// Radiance is emissiveFactor x KHR_materials_emissive_strength; exitance is pi times that.
Vec3 GltfMaterialReader::emission(const tinygltf::Material& gltf, const std::string& name) const {
  Vec3 factor{0.0};
  if (gltf.emissiveFactor.size() == 3) {
    factor = {gltf.emissiveFactor[0], gltf.emissiveFactor[1], gltf.emissiveFactor[2]};
  } else if (!gltf.emissiveFactor.empty()) {
    file_.fail(fmt::format("material {}: emissiveFactor is not 3 numbers; correct it", name));
  }
  double strength = 1;
  const auto extension = gltf.extensions.find("KHR_materials_emissive_strength");
  if (extension != gltf.extensions.end() && extension->second.Has("emissiveStrength")) {
    strength = extension->second.Get("emissiveStrength").GetNumberAsDouble();
  }
  return std::numbers::pi * strength * factor;
}

Index GltfMaterialReader::texture(const tinygltf::TextureInfo& info, TextureUse use,
                                  const std::string& material) {
  const std::string what = "material " + material;
  const tinygltf::Texture& gltf = file_.at(file_.model.textures, info.index, "texture", what);
  const auto unusable = [&](const std::string& image, const std::string& problem) {
    noteUnusedTexture(image, problem, use, "factor", material, ignored_);
    return kNone;
  };
  const int source = imageOf(gltf);
  if (source < 0) {
    return unusable(std::to_string(info.index), "has no image in PNG, JPEG or WebP");
  }
  const tinygltf::Image& image = file_.at(file_.model.images, source, "image", what);
  std::string name = image.name.empty() ? image.uri : image.name;
  if (name.empty()) name = fmt::format("image{}", source);
  const std::span<const unsigned char> bytes = file_.imageBytes(image, what);
  if (bytes.empty()) return unusable(name, kImageMissing);
  const bool repeat = repeats(gltf, material);
  const auto [place, is_new] = texture_of_.try_emplace({source, repeat});
  LoadedTexture& loaded = place->second;
  if (is_new) {
    TextureResult result = decodeTexture(name, bytes, options_.max_image);
    if (result.has_alpha) ignored_.add("alpha is not used, texture", name);
    loaded = keepTexture(std::move(result), repeat, scene_);
  }
  const std::string problem = loaded.problemAs(use);
  if (!problem.empty()) return unusable(name, problem);
  return loaded.index;
}

bool GltfMaterialReader::repeats(const tinygltf::Texture& texture, const std::string& material) {
  if (texture.sampler < 0) return true;
  const tinygltf::Sampler& sampler =
      file_.at(file_.model.samplers, texture.sampler, "sampler", "material " + material);
  const bool clamp = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
  const bool mirrored = sampler.wrapS == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ||
                        sampler.wrapT == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
  if (mirrored || sampler.wrapS != sampler.wrapT) {
    ignored_.add(fmt::format("texture wrapping that is mirrored or differs by axis is taken as {}, "
                             "material",
                             clamp ? "clamped" : "repeated"),
                 material, Severity::warning);
  }
  return !clamp;
}

TexcoordSource GltfMaterialReader::texcoords(const tinygltf::TextureInfo& info) {
  TexcoordSource source;
  source.set = info.texCoord;
  const auto extension = info.extensions.find(kTextureTransform);
  if (extension == info.extensions.end()) return source;
  const tinygltf::Value& transform = extension->second;
  if (!transform.IsObject()) return source;
  source.offset = pairOf(transform.Get("offset"), source.offset);
  source.scale = pairOf(transform.Get("scale"), source.scale);
  source.rotation = transform.Get("rotation").GetNumberAsDouble();
  if (transform.Has("texCoord")) source.set = transform.Get("texCoord").GetNumberAsInt();
  return source;
}

void GltfMaterialReader::noteIgnored(const tinygltf::Material& gltf, const std::string& name) {
  const tinygltf::PbrMetallicRoughness& pbr = gltf.pbrMetallicRoughness;
  if (pbr.metallicFactor != 0 && !gltf.extensions.contains(kSpecularGlossiness)) {
    ignored_.add("metalness is not used (glTF's default is 1), material", name);
  }
  if (pbr.roughnessFactor != 1 || pbr.metallicRoughnessTexture.index >= 0) {
    ignored_.add("roughness is not used, all is matt, material", name);
  }
  if (gltf.normalTexture.index >= 0) ignored_.add("normal maps are not used, material", name);
  if (gltf.occlusionTexture.index >= 0) ignored_.add("occlusion maps are not used, material", name);
  bool transparent = gltf.alphaMode == "BLEND";
  for (const auto& [extension, value] : gltf.extensions) {
    transparent = transparent || extension == "KHR_materials_transmission";
    if (isSupportedGltfExtension(extension)) continue;
    ignored_.add(extension + " is not used, material", name);
  }
  if (transparent) ignored_.add(solidFeature(), name, Severity::warning);
  if (gltf.alphaMode == "MASK") ignored_.add(maskFeature(), name, Severity::warning);
}

}  // namespace

/// KHR_texture_transform: scale, then a turn that is counter-clockwise as seen, v growing
/// downwards, then the offset.
Vec2 TexcoordSource::apply(const Vec2& uv) const {
  const Vec2 scaled = uv * scale;
  const double c = std::cos(rotation);
  const double s = std::sin(rotation);
  return Vec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x) + offset;
}

GltfMaterials readGltfMaterials(const GltfFile& file, const SceneOptions& options, Scene& scene,
                                FeatureNotes& ignored) {
  return GltfMaterialReader(file, options, scene, ignored).read();
}

}  // namespace radiosity
