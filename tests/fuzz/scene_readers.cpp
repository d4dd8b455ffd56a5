#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <pugixml.hpp>
#include <vector>

#include "base/csv.h"
#include "base/name_pattern.h"
#include "base/parse.h"
#include "fuzz/readers.h"
#include "radiosity/photometry.h"
#include "radiosity/scene.h"
#include "scene/assimp/collada_cameras.h"
#include "scene/assimp/nesting_preflight.h"
#include "scene/assimp/xml_preflight.h"
#include "scene/json_scan.h"
#include "scene/load_scene.h"
#include "scene/obj/camera_text.h"
#include "scene/scene_builder.h"

namespace radiosity {

namespace {

/// A file of scenes, through all checks that the program makes.
FuzzReader sceneReader(const char* name, const char* ending) {
  return {name, [ending](std::string_view bytes) {
            withFile(bytes, ending, [](const std::string& path) { loadScene(path, {}); });
          }};
}

void readMtl(std::string_view bytes) {
  withFile(bytes, ".mtl", [](const std::string& materials) {
    const std::string obj = "mtllib " + std::filesystem::path(materials).filename().string() +
                            "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    withFile(obj, ".obj", [](const std::string& path) { loadScene(path, {}); });
  });
}

/// What is done to Collada before Assimp has it.
void readDae(std::string_view bytes) {
  withFile(bytes, ".dae", [](const std::string& path) {
    FeatureNotes notes;
    ColladaCameras(checkXml(path), notes);
  });
}

FuzzReader lampReader(const char* name, const char* ending) {
  return {name, [ending](std::string_view bytes) {
            withFile(bytes, ending, [](const std::string& path) { readPhotometry(path); });
          }};
}

void readNesting(std::string_view bytes) { checkFbxNesting("a.fbx", bytes); }

void readPattern(std::string_view bytes) {
  const std::vector<std::string_view> lines = splitAt(bytes, '\n');
  isPattern(lines.front());
  matchesPattern(lines.front(), lines.back());
}

}  // namespace

std::span<const FuzzReader> sceneReaders() {
  static const std::array kReaders = {
      sceneReader("obj", ".obj"),
      FuzzReader{"mtl", readMtl},
      sceneReader("gltf", ".gltf"),
      sceneReader("glb", ".glb"),
      sceneReader("rad", ".rad"),
      sceneReader("stl", ".stl"),
      sceneReader("ply", ".ply"),
      sceneReader("off", ".off"),
      sceneReader("gmsh", ".msh"),
      sceneReader("view3d", ".vs3"),
      sceneReader("inp", ".inp"),
      sceneReader("vtk", ".vtk"),
      sceneReader("vtu", ".vtu"),
      sceneReader("3mf", ".3mf"),
      FuzzReader{"dae", readDae},
      FuzzReader{"nesting", readNesting},
      lampReader("ies", ".ies"),
      lampReader("ldt", ".ldt"),
      FuzzReader{"lamp", [](std::string_view bytes) { Photometry::ofText(bytes); }},
      FuzzReader{"csv", [](std::string_view bytes) { parseCsv("a.csv", bytes); }},
      FuzzReader{"camera", [](std::string_view bytes) { readCamera(bytes, ';'); }},
      FuzzReader{"pattern", readPattern},
      FuzzReader{"json", [](std::string_view bytes) {
                   scanJson("a.json", bytes, [](auto, const JsonValue&) {});
                 }}};
  return kReaders;
}

void withFile(std::string_view bytes, const char* ending,
              const std::function<void(const std::string& path)>& read) {
  const std::filesystem::path shared = "/dev/shm";  // no disk has to take part
  const std::filesystem::path folder =
      std::filesystem::exists(shared) ? shared : std::filesystem::temp_directory_path();
  struct File {
    std::string path;
    ~File() { unlink(path.c_str()); }
  } file{(folder / ("radiosity-fuzz-" + std::to_string(getpid()) + ending)).string()};
  std::ofstream(file.path, std::ios::binary) << bytes;
  read(file.path);
}

void readOrRefuse(const FuzzReader& reader, std::string_view bytes) {
  try {
    reader.read(bytes);
  } catch (const InputError&) {
  }
}

}  // namespace radiosity
