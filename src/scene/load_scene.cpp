#include "scene/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "scene/readers.h"

namespace radiosity {

namespace {

std::string lowerExtension(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return extension;
}

Scene readByExtension(const std::string& path, const SceneOptions& options) {
  const std::string extension = lowerExtension(path);
  if (extension == ".obj") return loadObj(path, options);
  if (extension == ".gltf" || extension == ".glb") {
    return loadGltf(path, extension == ".glb", options);
  }
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw InputError(fmt::format("{}: no such file; check the name and the folder", path));
  }
  if (std::filesystem::is_directory(path, ignored)) {
    throw InputError(fmt::format("{}: is a folder; name a scene file in it", path));
  }
  throw InputError(fmt::format(
      "{}: {} is not a scene format this program reads; export it as .obj, .gltf or .glb", path,
      extension.empty() ? "a file without an extension" : extension));
}

void convertToMetres(Scene& scene, const std::string& unit) {
  if (!unit.empty()) scene.unit = unit;
  const double factor = metresPer(scene.unit);
  if (factor == 1.0) return;
  for (Vec3& vertex : scene.vertices) vertex *= factor;
  for (Camera& camera : scene.cameras) {
    camera.eye *= factor;
    camera.target *= factor;
  }
}

void noteTextures(Scene& scene) {
  if (scene.textures.empty()) return;
  scene.notes.push_back(
      {Severity::info, fmt::format("{} texture{} read; a patch gets the mean over its area",
                                   scene.textures.size(), scene.textures.size() == 1 ? "" : "s")});
}

}  // namespace

Scene loadScene(const std::string& path, const SceneOptions& options) {
  options.validate();
  Scene scene = readByExtension(path, options);
  convertToMetres(scene, options.unit);
  noteTextures(scene);
  applyOverrides(scene, options);
  return scene;
}

}  // namespace radiosity
