#include "scene/obj/obj_materials.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <set>

#include "base/input_file.h"
#include "base/srgb.h"
#include "radiosity/spelling.h"
#include "scene/image_path.h"
#include "scene/obj/mtl_scan.h"
#include "scene/text.h"
#include "scene/texture.h"

namespace radiosity {

namespace {

namespace fs = std::filesystem;

class ObjMaterialReader {
 public:
  ObjMaterialReader(const SceneOptions& options, Scene& scene) : options_(options), scene_(scene) {}

  void readLibraries(const ObjScan& scan);
  std::vector<Index> resolve(const ObjScan& scan);

 private:
  void readLibrary(const fs::path& path);
  bool standsForMap(const MtlMaterial& mtl) const;
  Material convert(const MtlMaterial& mtl, const fs::path& folder);
  Index texture(const std::string& material, const char* keyword, TextureUse use, const MtlMap& map,
                const fs::path& folder);
  void noteTextureAlone(const std::string& factor, const std::string& material);
  void note(Severity severity, std::string text) {
    scene_.notes.push_back({severity, std::move(text)});
  }

  const SceneOptions& options_;
  Scene& scene_;
  std::map<std::string, Index> index_of_;
  std::map<std::pair<std::string, bool>, LoadedTexture> texture_of_;  ///< by path, repeat
  std::set<fs::path> read_;
  bool library_missing_ = false;
  FeatureNotes ignored_;
};

void ObjMaterialReader::readLibraries(const ObjScan& scan) {
  const fs::path folder = fs::path(scene_.file).parent_path();
  for (const auto& [line, text] : scan.libraries) {
    std::error_code error;
    // In the format blanks separate several names, but exporters write one name with blanks in it.
    std::vector<std::string_view> names = {text};
    if (!fs::is_regular_file(folder / text, error)) names = splitWords(text);
    for (const std::string_view name : names) {
      const fs::path path = folder / name;
      if (fs::exists(path, error) && !fs::is_regular_file(path, error)) {
        library_missing_ = true;
        note(Severity::warning, fmt::format("{}:{}: material file {}: {}", scene_.file, line,
                                            path.string(), whyNotAFile(path.string())));
      } else if (!fs::exists(path, error)) {
        library_missing_ = true;
        note(Severity::warning,
             fmt::format("{}:{}: material file {} is not there; give materials by {} or a JSON "
                         "materials file",
                         scene_.file, line, path.string(), spelled("set")));
      } else if (fs::file_size(path, error) == 0) {
        note(Severity::warning, fmt::format("{}: the material file is empty", path.string()));
      } else if (read_.insert(path.lexically_normal()).second) {
        readLibrary(path);
      }
    }
  }
  ignored_.appendTo(scene_.notes);
}

void ObjMaterialReader::readLibrary(const fs::path& path) {
  const std::string file = path.string();
  const std::vector<MtlMaterial> scanned = scanMtl(file, readWholeFile(file), ignored_);
  if (scanned.empty()) {
    note(Severity::warning,
         fmt::format("{}: defines no material (newmtl), so it is no MTL file; give materials by "
                     "{} or a JSON materials file",
                     file, spelled("set")));
    return;
  }
  for (const MtlMaterial& mtl : scanned) {
    if (!index_of_.try_emplace(mtl.name, Index(scene_.materials.size())).second) {
      note(Severity::warning,
           fmt::format("{}:{}: material {} is defined twice; the first definition counts", file,
                       mtl.line, mtl.name));
      continue;
    }
    scene_.materials.push_back(convert(mtl, path.parent_path()));
  }
}

/// Whether Kd only stands beside the map: 0, which exporters write and do not mean, or 1. But 1 is
/// what was asked for where textures are off.
bool ObjMaterialReader::standsForMap(const MtlMaterial& mtl) const {
  if (!mtl.reflectance_map || !mtl.reflectance) return false;
  return *mtl.reflectance == Vec3(0.0) || (options_.textures && *mtl.reflectance == Vec3(1.0));
}

Material ObjMaterialReader::convert(const MtlMaterial& mtl, const fs::path& folder) {
  Material material = defaultMaterial(mtl.name, options_);
  if (mtl.reflectance_map) {
    material.texture =
        texture(mtl.name, "map_Kd", TextureUse::reflectance, *mtl.reflectance_map, folder);
  }
  if (mtl.radiance_map) {
    material.emission_texture =
        texture(mtl.name, "map_Ke", TextureUse::emission, *mtl.radiance_map, folder);
  }
  if (material.texture != kNone && mtl.reflectance.value_or(Vec3(0.0)) == Vec3(0.0)) {
    material.reflectance = Vec3(1.0);
    if (mtl.reflectance) noteTextureAlone("Kd", mtl.name);
  } else if (material.texture == kNone && standsForMap(mtl)) {
    material.reflectance = mtl.reflectance.value_or(Vec3(0.0));
    replaceStandIn(material, mtl.name, "Kd", options_, ignored_);
  } else if (mtl.reflectance) {
    material.reflectance = *mtl.reflectance;
    if (options_.kd_is_srgb && isReflectance(material.reflectance)) {
      for (int b = 0; b < 3; ++b) material.reflectance[b] = linearFromSrgb(material.reflectance[b]);
    }
  } else {
    note(Severity::info, fmt::format("material {} gives no Kd: reflectance {}", mtl.name,
                                     options_.default_reflectance));
  }
  const bool lacks_map =
      mtl.radiance_map && options_.textures && material.emission_texture == kNone;
  if (mtl.radiance && !lacks_map) material.emission = std::numbers::pi * *mtl.radiance;
  if (material.emission_texture != kNone && material.emission == Vec3(0.0)) {
    material.emission = Vec3(std::numbers::pi);
    noteTextureAlone("Ke", mtl.name);
  }
  if (!mtl.out_of_range.empty() && !mayMend(options_)) {
    requireMaterial(mtl.out_of_range, material);
  }
  return material;
}

/// Exporters write a factor of 0 beside a texture and mean the texture.
void ObjMaterialReader::noteTextureAlone(const std::string& factor, const std::string& material) {
  ignored_.add(fmt::format("{0} is 0 beside map_{0}: the texture alone counts{1}, material", factor,
                           factor == "Ke" ? " (1 is 1 W/m^2/sr)" : ""),
               material);
}

Index ObjMaterialReader::texture(const std::string& material, const char* keyword, TextureUse use,
                                 const MtlMap& map, const fs::path& folder) {
  if (!options_.textures) {
    ignored_.add("textures are off; the factor alone counts, material", material);
    return kNone;
  }
  if (map.moved) {
    ignored_.add(fmt::format("{} options -s and -o are not used, material", keyword), material,
                 Severity::warning);
  }
  if (map.file.empty()) {
    noteUnusedTexture(keyword, "names no file that can be told from its options", use, "factor",
                      material, ignored_);
    return kNone;
  }
  const std::string path = findImage(folder.string(), map.file, ignored_);
  const auto [place, is_new] = texture_of_.try_emplace({path, !map.clamp});
  LoadedTexture& loaded = place->second;
  if (is_new) {
    TextureResult result = readTexture(path, options_.max_image);
    if (result.has_alpha) ignored_.add("alpha is not used, texture", path);
    loaded = keepTexture(std::move(result), !map.clamp, scene_);
  }
  const std::string problem = loaded.problemAs(use);
  if (problem.empty()) return loaded.index;
  noteUnusedTexture(path, problem, use, "factor", material, ignored_);
  return kNone;
}

std::vector<Index> ObjMaterialReader::resolve(const ObjScan& scan) {
  std::vector<Index> material_of;
  std::vector<std::string> unknown;
  for (const std::string& name : scan.materials) {
    const auto [place, is_new] = index_of_.try_emplace(name, Index(scene_.materials.size()));
    if (is_new) {
      scene_.materials.push_back(defaultMaterial(name, options_));
      unknown.push_back(name);
    }
    material_of.push_back(place->second);
  }
  if (!unknown.empty()) {
    note(Severity::warning,
         fmt::format("reflectance {} and no emission for materials that {}: {}",
                     options_.default_reflectance,
                     library_missing_ ? "the missing file would define" : "no file defines",
                     joinNames(unknown)));
  }
  return material_of;
}

}  // namespace

std::vector<Index> readObjMaterials(const ObjScan& scan, const SceneOptions& options,
                                    Scene& scene) {
  ObjMaterialReader reader(options, scene);
  reader.readLibraries(scan);
  return reader.resolve(scan);
}

}  // namespace radiosity
