#include "bench_scenes.h"

#include <utility>

#include "radiosity/scene.h"

namespace radiosity::bench {
namespace {

BenchScene load(const std::string& name) {
  const Scene scene = loadScene(RADIOSITY_SOURCE_DIR "/data/" + name + ".obj");
  MeshOptions options;
  Progress silent;
  PatchMesh mesh = meshScene(scene, options, silent).mesh;
  options.patches *= 4;
  return {name, std::move(mesh), meshScene(scene, options, silent).mesh};
}

}  // namespace

std::vector<BenchScene> benchScenes() {
  std::vector<BenchScene> scenes;
  for (const char* name : {"cornell-box", "cornell-box-closed", "cluttered"}) {
    scenes.push_back(load(name));
  }
  return scenes;
}

}  // namespace radiosity::bench
