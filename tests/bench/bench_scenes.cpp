#include "bench_scenes.h"

#include <utility>

namespace radiosity::bench {

BenchScene benchScene(const std::string& name, std::size_t patches) {
  Scene scene = loadScene(RADIOSITY_SOURCE_DIR "/data/" + name + ".obj");
  MeshOptions options;
  options.patches = patches;
  Progress silent;
  PatchMesh mesh = meshScene(scene, options, silent).mesh;
  return {name, std::move(scene), std::move(mesh)};
}

std::vector<RateScene> rateScenes() {
  const std::size_t patches = MeshOptions().patches;
  std::vector<RateScene> scenes;
  for (const char* name : {"cornell-box", "cornell-box-closed", "cluttered"}) {
    scenes.push_back({name, benchScene(name, patches).mesh, benchScene(name, 4 * patches).mesh});
  }
  return scenes;
}

std::vector<CurveScene> curveScenes(bool quick) {
  // The furnished room and the curved scene start at the least that their polygons need: about
  // 9,500 and 2,200 patches.
  std::vector<CurveScene> scenes = {{"cornell-box-closed", 250, 1e-7},
                                    {"cornell-box-closed", 1000, 1e-7}};
  if (quick) return scenes;
  scenes.push_back({"cornell-box-closed", 5000, 1e-7});
  scenes.push_back({"cornell-box-closed", 20000, 1e-7});
  scenes.push_back({"cluttered", 1000, 1e-4});
  scenes.push_back({"curved", 1000, 1e-4});
  scenes.push_back({"furnished-room", 1000, 1e-4});
  return scenes;
}

}  // namespace radiosity::bench
