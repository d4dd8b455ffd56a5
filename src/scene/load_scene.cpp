#include "scene/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <new>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/file_name.h"
#include "base/input_file.h"
#include "radiosity/spelling.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/text.h"

namespace radiosity {

namespace {

struct Format {
  const char* extension;
  Scene (*load)(const std::string&, const SceneOptions&);
  Up up = Up::y;  ///< the usual one of the format
};

constexpr std::array kFormats = {
    Format{".obj", loadObj},           Format{".gltf", loadGltf},
    Format{".glb", loadGltf},          Format{".rad", loadRadiance, Up::z},
    Format{".stl", loadStl, Up::z},    Format{".vs3", loadView3d, Up::z},
    Format{".v3d", loadView3d, Up::z}, Format{".msh", loadGmsh, Up::z},
    Format{".inp", loadInp, Up::z},    Format{".ply", loadPly},
    Format{".vtk", loadVtk, Up::z},    Format{".vtp", loadVtkXml, Up::z},
    Format{".vtu", loadVtkXml, Up::z}, Format{".dae", loadAssimp},
    Format{".fbx", loadAssimp},        Format{".3ds", loadAssimp},
    Format{".ifc", loadAssimp},        Format{".dxf", loadAssimp, Up::z},
    Format{".off", loadOff},           Format{".3mf", load3mf, Up::z},
};

/// Formats that a converter reads.
constexpr std::array kConvertible = {".x3d", ".wrl", ".ac", ".acc", ".lwo", ".ms3d", ".b3d"};

Scene readByExtension(const std::string& path, const SceneOptions& options) {
  requireFile(path);
  const std::string extension = lowerExtension(path);
  for (const Format& format : kFormats) {
    if (extension != format.extension) continue;
    Scene scene = format.load(path, options);
    scene.up = format.up;
    return scene;
  }
  if (extension == ".gz") {
    throw InputError(
        fmt::format("{0}: is packed by gzip; unpack it first: gunzip --keep '{0}'", path));
  }
  if (std::ranges::find(kConvertible, extension) != kConvertible.end()) {
    throw InputError(
        fmt::format("{0}: {1} is not read; convert it first, by Blender or by assimp-utils: assimp "
                    "export '{0}' '{2}.glb'",
                    path, extension, path.substr(0, path.size() - extension.size())));
  }
  throw InputError(fmt::format(
      "{}: {} is not a scene format this program reads; export it as one "
      "of {}",
      path, extension.empty() ? "a file without an extension" : extension, sceneExtensions()));
}

/// Where a light stands and ends; what it sends has its own unit.
void convertToMetres(LightKind& kind, double factor) {
  std::visit(
      [factor](auto& light) {
        if constexpr (requires { light.at; }) light.at *= factor;
        if constexpr (requires { light.range; }) light.range *= factor;
        if constexpr (requires { *light.aim; }) {
          if (light.aim) *light.aim *= factor;
        } else if constexpr (requires { light.aim; }) {
          light.aim *= factor;
        }
      },
      kind);
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
  for (Light& light : scene.lights) convertToMetres(light.kind, factor);
}

void noteTextures(Scene& scene) {
  if (scene.textures.empty()) return;
  scene.notes.push_back(
      {Severity::info, fmt::format("{} texture{} read; a patch gets the mean over its area",
                                   scene.textures.size(), scene.textures.size() == 1 ? "" : "s")});
}

/// The largest coordinate: beyond, squares and cubes of lengths overflow.
constexpr double kFarthest = 1e30;

void requireExtent(const Scene& scene) {
  for (std::size_t f = 0; f < scene.faceCount(); ++f) {
    for (const Index corner : scene.face(f)) {
      const Vec3 size = glm::abs(scene.vertices[corner]);
      if (std::max({size.x, size.y, size.z}) <= kFarthest) continue;
      throw InputError(
          fmt::format("{}: a corner of the face at {} lies {:.3g} m away; the file is damaged or "
                      "its unit is wrong",
                      scene.file, scene.face_element[f], std::max({size.x, size.y, size.z})));
    }
  }
}

Scene readScene(const std::string& path, const SceneOptions& options) {
  try {
    return readByExtension(path, options);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw RunError(path + ": the scene does not fit into memory; split it, or use a larger machine");
}

}  // namespace

std::string sceneExtensions() {
  std::string list;
  for (const Format& format : kFormats) {
    if (!list.empty()) list += ", ";
    list += format.extension;
  }
  return list;
}

Scene loadScene(const std::string& path, const SceneOptions& options) {
  options.validate();
  Scene scene = readScene(path, options);
  convertToMetres(scene, options.unit);
  requireExtent(scene);
  noteTextures(scene);
  if (options.vertex_colours != VertexColours::unused && scene.colours.empty()) {
    scene.notes.push_back(
        {Severity::warning, spelled("vertex_colours") + ": no vertex has a colour that is read"});
  }
  applyOverrides(scene, options);
  requireMaterials(scene, options);
  return scene;
}

}  // namespace radiosity
